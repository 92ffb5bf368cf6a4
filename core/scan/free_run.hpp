#pragma once

/// A camera that runs free for a while.

#include "core/hw/camera.hpp"

namespace fvd {

/// Triggered by software again when this ends. A camera's frames must be gone before it is configured anew, so whoever
/// still computes on them ends before this does.
/// context: the scan's thread.
class FreeRun {
 public:
  /// settings: those in force, with a trigger by software. The camera outlives this.
  FreeRun(Camera& camera, const CameraSettings& settings) : camera_(camera), quiet_(settings) {}
  ~FreeRun();
  FreeRun(const FreeRun&) = delete;
  FreeRun& operator=(const FreeRun&) = delete;

  /// Throws what Camera::configure throws.
  void begin(double frame_rate_hz);

  [[nodiscard]] const CameraSettings& settings() const noexcept { return quiet_; }

 private:
  Camera& camera_;
  const CameraSettings quiet_;
  bool begun_ = false;
};

}  // namespace fvd
