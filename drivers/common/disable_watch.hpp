#pragma once

/// Tells a drive that somebody else has disabled - an emergency stop, a power cut - from one that a stop of ours did:
/// the former may have been moved by hand since.

#include <algorithm>
#include <atomic>
#include <chrono>

#include "core/base/clock.hpp"
#include "drivers/common/position_log.hpp"

namespace fvd {

/// context: thread-safe.
class DisableWatch {
 public:
  /// The drive took the command to enable.
  void enabled() noexcept { expects_enabled_ = true; }

  /// A stop is sent, which disables some drives. It explains nothing about a drive that was disabled before.
  void stopping(const AxisSample& latest) noexcept {
    stopped_ = HostClock::now();
    if (latest.enabled) expects_enabled_ = false;
  }

  /// A drive that is still enabled so long after a stop, and after the braking that followed, was not disabled by it.
  void saw(const AxisSample& sample) noexcept {
    if (sample.moving) {
      stopped_ = std::max(stopped_.load(), sample.begun);
    } else if (sample.enabled && sample.begun > stopped_.load() + kDisablingTime) {
      expects_enabled_ = true;
    }
  }

  [[nodiscard]] bool somebody_else_disabled(const AxisSample& sample) const noexcept {
    return !sample.enabled && expects_enabled_;
  }

 private:
  /// A drive that a stop disables is disabled within this time.
  static constexpr std::chrono::milliseconds kDisablingTime{500};

  std::atomic<bool> expects_enabled_{false};
  std::atomic<HostTime> stopped_{HostTime{}};
};

}  // namespace fvd
