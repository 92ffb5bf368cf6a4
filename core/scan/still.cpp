#include "core/scan/still.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/scan/slice_capture.hpp"

namespace fvd {

namespace {

constexpr int kFrameRetries = 3;
constexpr int kMostExposureLooks = 8;
/// The exposure is right when the factor that would correct it differs from 1 by no more.
constexpr double kExposureTolerance = 0.05;

}  // namespace

Still take_still(Camera& camera, Clock& clock, const CameraSettings& settings, std::stop_token stop) {
  const std::stop_callback wake(stop, [&camera] { camera.interrupt(); });
  // configure() cancels what was asked of the camera before, also by this stop.
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "stopped before the camera was set up");
  Still still;
  still.settings = camera.configure(settings);
  FrameLedger ledger;
  SliceCapture capture(camera, clock, ledger);
  auto captured = capture.capture(clock.now(), kFrameRetries, std::move(stop));
  if (!captured) throw capture.failure("no good frame");
  still.frame = std::move(captured->frame);
  return still;
}

ExposureFound find_exposure(Camera& camera, Clock& clock, CameraSettings settings, double target,
                            std::stop_token stop) {
  ExposureFound found;
  while (found.looks < kMostExposureLooks && !found.reached) {
    const Still still = take_still(camera, clock, settings, stop);
    found.grey = grey_statistics(still.frame.image);
    found.exposure_us = still.settings.exposure_us;
    ++found.looks;
    const double factor = exposure_factor(found.grey, still.frame.image.format, target);
    found.reached = std::abs(factor - 1.0) <= kExposureTolerance;
    settings.exposure_us = found.exposure_us * factor;
  }
  return found;
}

}  // namespace fvd
