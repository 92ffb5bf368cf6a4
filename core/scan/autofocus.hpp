#pragma once

/// Finds the height at which a region is sharpest: a coarse scan, a finer one around its maximum, a parabola.

#include <stop_token>
#include <vector>

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"

namespace fvd {

/// Part of an image, pixels.
struct Region {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};
/// The middle half of an image on both sides.
[[nodiscard]] Region central_region(int width, int height);

/// Mean modified Laplacian |2I - I(x-1) - I(x+1)| + |2I - I(y-1) - I(y+1)| over the region, in grey levels (Nayar and
/// Nakagawa, IEEE PAMI 16(8), 1994). The region's inner pixels only; it is cut to the image.
[[nodiscard]] double mean_focus(const ImageView& image, const Region& region);

struct AutofocusPlan {
  Micrometers from;
  Micrometers to;          ///< > from
  Micrometers step{10.0};  ///< of the coarse scan, > 0; the fine one has a quarter
  int frame_retries = 3;
  SettleCriterion settle;
};

struct FocusSample {
  double z_um = 0.0;  ///< measured
  double focus = 0.0;
};

struct AutofocusResult {
  double z_um = 0.0;               ///< where it is sharpest; the stage stands there
  double focus = 0.0;              ///< largest value seen
  std::vector<FocusSample> curve;  ///< by height
};

/// The camera is configured and triggered by software, the stage homed. Every move arrives from below. Throws Error
/// kBadInput for a range without three steps, kStageLimit, kStageNotHomed, kCameraFramesLost, kFocusRange if it is
/// sharpest at an end of the range or nowhere, kAborted, and what camera and stage throw. context: the scan's thread.
[[nodiscard]] AutofocusResult autofocus(Camera& camera, Axis& stage, Clock& clock, const AutofocusPlan& plan,
                                        std::stop_token stop);

}  // namespace fvd
