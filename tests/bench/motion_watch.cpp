#include "tests/bench/motion_watch.hpp"

#include <cmath>
#include <thread>
#include <utility>

#include "core/base/clock.hpp"

namespace fvd::bench {

MotionWatch::MotionWatch(const sim::AxisModel& axis)
    : axis_(axis), thread_(start_thread("motion-watch", [this](const std::stop_token& stop) { run(stop); })) {}

std::vector<WallTime> MotionWatch::take_moving() {
  const MutexLock lock(mutex_);
  return std::exchange(moving_, {});
}

void MotionWatch::run(const std::stop_token& stop) {
  SystemClock clock;
  HostTime before = clock.now();
  double position_um = axis_.true_position_um(before);
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(kPeriod);
    const HostTime now = clock.now();
    const double here_um = axis_.true_position_um(now);
    const double speed_um_per_s = std::abs(here_um - position_um) / std::chrono::duration<double>(now - before).count();
    before = now;
    position_um = here_um;
    if (speed_um_per_s < kMovingSpeed_um_per_s) continue;
    const MutexLock lock(mutex_);
    moving_.push_back(std::chrono::system_clock::now());
  }
}

}  // namespace fvd::bench
