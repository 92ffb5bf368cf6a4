#pragma once

/// The times at which the simulated axis truly moved, from its position every 2 ms.

#include <chrono>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "sim/axis/axis_model.hpp"

namespace fvd::bench {

using WallTime = std::chrono::system_clock::time_point;

/// context: thread-safe.
class MotionWatch {
 public:
  static constexpr std::chrono::milliseconds kPeriod{2};
  /// Speed above which the axis counts as moving: below any motion of a scan, above drift, ringing and settle noise.
  static constexpr double kMovingSpeed_um_per_s = 20.0;

  /// The axis outlives the watch.
  explicit MotionWatch(const sim::AxisModel& axis);

  /// The times at which the axis moved since the last call, in order.
  [[nodiscard]] std::vector<WallTime> take_moving();

 private:
  void run(const std::stop_token& stop);

  const sim::AxisModel& axis_;
  Mutex mutex_;
  std::vector<WallTime> moving_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd::bench
