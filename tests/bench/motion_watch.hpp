#pragma once

/// When the simulated axis truly moved: its position every 2 ms, whoever commands it.

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
  /// Slower than any motion of a scan, faster than drift, ringing that dies away and the noise of settling.
  static constexpr double kMovingSpeed_um_per_s = 20.0;

  /// The axis outlives the watch.
  explicit MotionWatch(const sim::AxisModel& axis);

  /// The times at which the axis moved, in order. What was given out is forgotten.
  [[nodiscard]] std::vector<WallTime> take_moving();

 private:
  void run(const std::stop_token& stop);

  const sim::AxisModel& axis_;
  Mutex mutex_;
  std::vector<WallTime> moving_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd::bench
