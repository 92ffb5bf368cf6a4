#pragma once

/// Single pictures of a stage that rests, and the exposure that suits what they show.

#include <stop_token>

#include "core/base/clock.hpp"
#include "core/focus/grey_statistics.hpp"
#include "core/hw/camera.hpp"

namespace fvd {

struct Still {
  Frame frame;              ///< kOk
  CameraSettings settings;  ///< in force
};

/// Configures the camera and takes a frame that is exposed from now on. Throws Error kCameraFramesLost after four
/// triggers without a good frame, kCameraNoFrames where nothing at all came, kAborted, and what the camera throws.
[[nodiscard]] Still take_still(Camera& camera, Clock& clock, const CameraSettings& settings, std::stop_token stop);

struct ExposureFound {
  double exposure_us = 0.0;  ///< of the last image
  bool reached = false;      ///< the factor that would correct it differs from 1 by 5 % at most
  int looks = 0;             ///< images that it took, 1..8
  GreyStatistics grey;       ///< of the last image
};

/// Adjusts the exposure until 0.1 % of the pixels exceed `target` of full scale, 0 < target < 1; at most 8 images. The
/// camera keeps the last exposure. Throws as take_still().
[[nodiscard]] ExposureFound find_exposure(Camera& camera, Clock& clock, CameraSettings settings, double target,
                                          std::stop_token stop);

}  // namespace fvd
