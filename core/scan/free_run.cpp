#include "core/scan/free_run.hpp"

#include <exception>

namespace fvd {

FreeRun::~FreeRun() {
  if (!begun_) return;
  try {
    (void)camera_.configure(quiet_);
  } catch (const std::exception&) {
    // A camera that cannot be quietened is lost; whoever uses it next is told so.
  }
}

void FreeRun::begin(double frame_rate_hz) {
  CameraSettings settings = quiet_;
  settings.trigger = TriggerMode::kFreeRun;
  settings.frame_rate_hz = frame_rate_hz;
  begun_ = true;  // also if the camera refuses half of it
  (void)camera_.configure(settings);
}

}  // namespace fvd
