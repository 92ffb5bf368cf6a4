#include "sim/camera/line_trigger.hpp"

#include <utility>

#include "core/runtime/guarded_thread.hpp"

namespace fvd::sim {

namespace {

constexpr std::chrono::microseconds kPeriod{200};

}  // namespace

LineTrigger::LineTrigger(const AxisModel& axis, std::function<void()> edge)
    : axis_(axis),
      edge_(std::move(edge)),
      thread_(start_thread("sim-line", [this](std::stop_token stop) { watch(stop); })) {}

void LineTrigger::watch(std::stop_token stop) const {
  bool before = true;
  while (!stop.stop_requested()) {
    const bool now = axis_.in_position(HostClock::now());
    if (now && !before) edge_();
    before = now;
    std::this_thread::sleep_for(kPeriod);
  }
}

}  // namespace fvd::sim
