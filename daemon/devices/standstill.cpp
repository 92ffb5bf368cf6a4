#include "daemon/devices/standstill.hpp"

#include <chrono>
#include <cmath>
#include <optional>
#include <stop_token>
#include <utility>

namespace fvd {

namespace {

/// An axis that was told to stop comes to rest within this time; one that does not is looked at again later.
constexpr std::chrono::milliseconds kStoppingTime{500};
constexpr std::chrono::milliseconds kLookPeriod{20};
/// Positions of two looks that differ by no more are the same.
constexpr double kStandstillWindow_um = 1.0;

/// As the driver has it: a drive without torque may report that it is not in position, which is no motion.
bool moves(const StageStatus& status) {
  return (status.moving && status.enabled) || status.state == AxisState::kMoving || status.state == AxisState::kHoming;
}

}  // namespace

bool bring_to_rest(Axis& axis, Clock& clock, const std::function<void()>& on_motion) {
  const HostTime deadline = clock.now() + kStoppingTime;
  std::optional<Micrometers> resting;
  bool told_to_stop = false;
  for (;;) {
    const StageStatus status = axis.status();
    if (moves(status)) {
      on_motion();
      if (!std::exchange(told_to_stop, true)) axis.stop();
      resting.reset();
    } else if (resting && std::abs(status.position.value - resting->value) <= kStandstillWindow_um) {
      return true;
    } else {
      resting = status.position;
    }
    const HostTime now = clock.now();
    if (now > deadline) break;
    clock.wait_until(now + kLookPeriod, std::stop_token{});
  }
  if (!told_to_stop) axis.stop();  // it creeps, though it reports rest
  return false;
}

}  // namespace fvd
