#pragma once

/// The one test of rest: when an axis counts as standing still, and how long that may take.

#include <algorithm>
#include <chrono>

#include "core/base/clock.hpp"
#include "core/base/units.hpp"

namespace fvd {

/// Positions that differ by no more are the same place: 1 um, or two steps of a coarser encoder.
[[nodiscard]] inline Micrometers rest_window(Micrometers feedback_resolution) {
  return std::max(Micrometers{1.0}, feedback_resolution * 2.0);
}

/// Standstill: looks over at least 50 ms, three or more, none of which reports motion, all within the window. One look
/// says little: a controller may report rest before it starts, or while it creeps.
/// context: one thread at a time.
class RestDetector {
 public:
  static constexpr int kLooks = 3;
  static constexpr std::chrono::milliseconds kDuration{50};

  explicit RestDetector(Micrometers window) : window_(window) {}

  /// time: of the position. True once the looks since motion was seen last are a standstill.
  bool add(HostTime time, Micrometers position, bool reports_rest);
  /// Motion was seen: a report of it, or a position outside the window.
  [[nodiscard]] bool saw_motion() const { return restarts_ > 1 || count_ == 0; }
  /// Forgets what it saw.
  void reset() { *this = RestDetector(window_); }

 private:
  Micrometers window_;
  int count_ = 0;
  int restarts_ = 0;
  HostTime first_{};
  Micrometers low_{};
  Micrometers high_{};
};

/// Longest time from a stop to a standstill: braking, and two seconds for the rest. Speed >= 0; an acceleration of 0
/// stands for an axis that needs no time to brake.
[[nodiscard]] std::chrono::milliseconds standstill_timeout(double speed_um_per_s, double acceleration_um_per_s2);

}  // namespace fvd
