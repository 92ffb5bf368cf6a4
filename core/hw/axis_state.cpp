#include "core/hw/axis.hpp"

namespace fvd {

const char* axis_state_name(AxisState state) noexcept {
  switch (state) {
    case AxisState::kDisconnected:
      return "Disconnected";
    case AxisState::kIdentifying:
      return "Identifying";
    case AxisState::kDisabled:
      return "Disabled";
    case AxisState::kNotHomed:
      return "NotHomed";
    case AxisState::kHoming:
      return "Homing";
    case AxisState::kReady:
      return "Ready";
    case AxisState::kMoving:
      return "Moving";
    case AxisState::kSettling:
      return "Settling";
    case AxisState::kAlarm:
      return "Alarm";
    case AxisState::kCommLost:
      return "CommLost";
  }
  return "Disconnected";
}

}  // namespace fvd
