#include "daemon/devices/standstill.hpp"

#include <chrono>
#include <stop_token>
#include <utility>

#include "drivers/common/rest_detector.hpp"

namespace fvd {

namespace {

constexpr std::chrono::milliseconds kLookPeriod{20};
/// One that still moves then is looked at again later: nothing here can be interrupted.
constexpr std::chrono::milliseconds kStoppingTime{1000};

}  // namespace

bool reports_motion(const StageStatus& status) {
  // A drive without torque may report that it is not in position, which is no motion.
  return (status.moving && status.enabled) || status.state == AxisState::kMoving || status.state == AxisState::kHoming;
}

std::optional<Micrometers> bring_to_rest(Axis& axis, Clock& clock, const std::function<void()>& on_motion) {
  const StageInfo info = axis.info();
  const HostTime deadline = clock.now() + kStoppingTime;
  RestDetector rest(rest_window(info.feedback_resolution));
  bool told_to_stop = false;
  for (;;) {
    const StageStatus status = axis.status();
    const HostTime now = clock.now();
    const bool moves = reports_motion(status);
    if (moves) {
      on_motion();
      if (!std::exchange(told_to_stop, true)) axis.stop();
    }
    if (rest.add(now, status.position, !moves)) return status.position;
    if (now > deadline) break;
    clock.wait_until(now + kLookPeriod, std::stop_token{});
  }
  if (!told_to_stop) axis.stop();  // it creeps, though it reports rest
  return std::nullopt;
}

}  // namespace fvd
