#include "sim/drives/az_drive.hpp"

#include <cmath>

namespace fvd::sim {

namespace {

namespace reg {
constexpr int kDirectFirst = 0x0058;
constexpr int kDirectType = 0x005A;
constexpr int kDirectPosition = 0x005C;
constexpr int kDirectSpeed = 0x005E;
constexpr int kDirectChanging = 0x0060;
constexpr int kDirectStopping = 0x0062;
constexpr int kDirectTrigger = 0x0066;
constexpr int kDirectLast = 0x0069;
constexpr int kInputAutoOff = 0x0078;
constexpr int kInputLevel = 0x007C;
constexpr int kOutput = 0x007E;
constexpr int kAlarm = 0x0080;
constexpr int kCommandPosition = 0x00C6;
constexpr int kActualPosition = 0x00CC;
constexpr int kDriverTemperature = 0x00F8;
constexpr int kMotorTemperature = 0x00FA;
constexpr int kActualPosition32 = 0x0120;
constexpr int kCommandPosition32 = 0x0122;
constexpr int kFixedImage = 0x0178;
constexpr int kAlarmReset = 0x0180;
constexpr int kPreset = 0x018A;
constexpr int kLimitAction = 0x0386;
constexpr int kLimitPlus = 0x0388;
constexpr int kLimitMinus = 0x038A;
constexpr int kPresetValue = 0x038C;
}  // namespace reg

namespace bit {
constexpr unsigned kHome = 1U << 4U;
constexpr unsigned kStop = 1U << 5U;
constexpr unsigned kFree = 1U << 6U;
constexpr unsigned kAlarmReset = 1U << 7U;
constexpr unsigned kHomeEnd = 1U << 4U;
constexpr unsigned kReady = 1U << 5U;
constexpr unsigned kAlarmA = 1U << 7U;
constexpr unsigned kBusy = 1U << 8U;
constexpr unsigned kMove = 1U << 13U;
constexpr unsigned kInPosition = 1U << 14U;
}  // namespace bit

constexpr int kRegisters = 0x0400;

constexpr int kAlarmLimitSwitch = 0x66;
constexpr int kAlarmOvertravel = 0x67;
constexpr int kAlarmTorqueOff = 0x68;

/// Driver and motor are warmer than the axis by so much, K.
constexpr double kDriverAboveAxis = 21.2;
constexpr double kMotorAboveAxis = 18.5;

std::int32_t tenths(double value) { return static_cast<std::int32_t>(std::lround(10.0 * value)); }

/// Operation types: where a target counts from.
constexpr int kAbsolute = 1;
constexpr int kFromCommand = 2;
constexpr int kFromActual = 3;

}  // namespace

AzDrive::AzDrive(AxisModel& axis, DriveClock clock) : SimDrive(axis, std::move(clock)) {
  using enum RegisterImage::Access;
  image().add_area(0, kRegisters, kReadWrite);
  image().add_area(reg::kOutput, reg::kFixedImage + 8 - reg::kOutput, kReadOnly);
  power_on();
}

void AzDrive::power_on() {
  image().set_value(reg::kLimitAction, -1);
  level_ = 0;
}

void AzDrive::refresh(HostTime now) {
  const bool moving = reports_motion(now);
  const bool homed = axis().homed(now);
  const bool in_position = reports_in_position(now);
  const bool is_in_alarm = alarm() != 0;
  const bool ready = !is_in_alarm && !moving && (level_ & (bit::kStop | bit::kFree)) == 0;
  const unsigned output = (homed ? bit::kHomeEnd : 0U) | (ready ? bit::kReady : 0U) |
                          (is_in_alarm ? bit::kAlarmA : 0U) | (moving ? bit::kBusy | bit::kMove : 0U) |
                          (in_position ? bit::kInPosition : 0U);
  image().set_word(reg::kOutput + 1, output);
  image().set_value(reg::kAlarm, alarm());
  image().set_value(reg::kCommandPosition, command_position(now));
  image().set_value(reg::kCommandPosition32, command_position(now));
  const std::int32_t actual = actual_position(now);
  image().set_value(reg::kActualPosition, actual);
  image().set_value(reg::kActualPosition32, actual);
  const double temperature = axis().temperature_c(now);
  image().set_value(reg::kDriverTemperature, tenths(temperature + kDriverAboveAxis));
  image().set_value(reg::kMotorTemperature, tenths(temperature + kMotorAboveAxis));
  // Signal n of the fixed image is bit n % 16 of word n / 16.
  image().set_word(reg::kFixedImage, homed ? 1U : 0U);
  image().set_word(reg::kFixedImage + 1, (is_in_alarm ? 1U << 1U : 1U << 2U) | (1U << 3U) | (ready ? 1U << 4U : 0U) |
                                             (moving ? 1U << 6U | 1U << 8U : 0U) | (in_position ? 1U << 10U : 0U));
}

void AzDrive::was_written(const Written& written, HostTime now) {
  if (written.value(reg::kAlarmReset) && image().value(reg::kAlarmReset) == 1) {
    set_alarm(0);
    image().set_value(reg::kAlarmReset, 0);
  }
  if (written.value(reg::kPreset) && image().value(reg::kPreset) == 1) {
    if (!axis().moving(now)) preset_position(now, image().value(reg::kPresetValue));
    image().set_value(reg::kPreset, 0);
  }
  act_on_direct_data(written, now);
  const unsigned auto_off = image().word(reg::kInputAutoOff + 1);
  image().set_word(reg::kInputAutoOff + 1, 0);
  const unsigned level = image().word(reg::kInputLevel + 1);
  const unsigned rising = auto_off | (level & ~level_);
  level_ = level;
  act_on_inputs(rising, now);
}

void AzDrive::act_on_direct_data(const Written& written, HostTime now) {
  if (written.first > reg::kDirectLast || written.first + written.count <= reg::kDirectFirst) return;
  const std::int32_t trigger = image().value(reg::kDirectTrigger);
  // Trigger 1 starts when it is written; -n keeps standing and starts whenever item n (counted back from the trigger)
  // is.
  const bool by_trigger = trigger == 1 && written.value(reg::kDirectTrigger);
  const bool by_item = trigger <= -1 && trigger >= -7 && written.value(reg::kDirectTrigger + 2 * trigger) &&
                       !written.value(reg::kDirectTrigger);
  if (by_trigger) image().set_value(reg::kDirectTrigger, 0);
  if (by_trigger || by_item) start_direct_operation(now);
}

void AzDrive::act_on_inputs(unsigned rising, HostTime now) {
  if ((rising & (bit::kStop | bit::kFree)) != 0) axis().stop(now);
  if ((rising & bit::kAlarmReset) != 0) set_alarm(0);
  const bool ready = alarm() == 0 && !axis().moving(now) && (level_ & (bit::kStop | bit::kFree)) == 0;
  if ((rising & bit::kHome) != 0 && (rising & bit::kStop) == 0 && ready) start_home(now);
}

bool AzDrive::leaves_limits(std::int64_t target, HostTime now) {
  return image().value(reg::kLimitAction) == 1 && axis().homed(now) &&
         (target > image().value(reg::kLimitPlus) || target < image().value(reg::kLimitMinus));
}

void AzDrive::start_direct_operation(HostTime now) {
  const std::int32_t type = image().value(reg::kDirectType);
  const bool stopped = (image().word(reg::kInputLevel + 1) & (bit::kStop | bit::kFree)) != 0;
  // An absolute AZ move may be re-targeted while it runs; anything else needs READY.
  if (alarm() != 0 || stopped || (axis().moving(now) && type != kAbsolute)) return;
  if (type != kAbsolute && type != kFromCommand && type != kFromActual) return;
  std::int64_t target = image().value(reg::kDirectPosition);
  if (type == kFromCommand) target += command_position(now);
  if (type == kFromActual) target += actual_position(now);
  if (leaves_limits(target, now)) {
    set_alarm(kAlarmOvertravel);
    return;
  }
  start_move(now, target, image().value(reg::kDirectSpeed), image().value(reg::kDirectChanging),
             image().value(reg::kDirectStopping));
}

void AzDrive::on_limit(HostTime /*now*/) { set_alarm(kAlarmLimitSwitch); }

void AzDrive::on_torque_off(HostTime /*now*/) { set_alarm(kAlarmTorqueOff); }

}  // namespace fvd::sim
