#include "sim/az_drive.hpp"

#include <algorithm>

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
constexpr int kLimitAction = 0x0386;
constexpr int kLimitPlus = 0x0388;
constexpr int kLimitMinus = 0x038A;
}  // namespace reg

namespace bit {
constexpr unsigned kHome = 1U << 4U;
constexpr unsigned kStop = 1U << 5U;
constexpr unsigned kAlarmReset = 1U << 7U;
constexpr unsigned kHomeEnd = 1U << 4U;
constexpr unsigned kReady = 1U << 5U;
constexpr unsigned kAlarmA = 1U << 7U;
constexpr unsigned kBusy = 1U << 8U;
constexpr unsigned kMove = 1U << 13U;
constexpr unsigned kInPosition = 1U << 14U;
}  // namespace bit

constexpr int kAlarmOvertravel = 0x67;

/// Operation types: where a target counts from.
constexpr int kAbsolute = 1;
constexpr int kFromCommand = 2;
constexpr int kFromActual = 3;

}  // namespace

AzDrive::AzDrive(AxisModel& axis) : axis_(axis) { set_long(reg::kLimitAction, -1); }

std::int32_t AzDrive::long_at(int address) const {
  const auto at = static_cast<std::size_t>(address);
  return static_cast<std::int32_t>((static_cast<std::uint32_t>(registers_[at]) << 16U) | registers_[at + 1]);
}

void AzDrive::set_long(int address, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  const auto at = static_cast<std::size_t>(address);
  registers_[at] = static_cast<std::uint16_t>(bits >> 16U);
  registers_[at + 1] = static_cast<std::uint16_t>(bits & 0xFFFFU);
}

bool AzDrive::ready(HostTime now) const { return alarm_ == 0 && !axis_.moving(now); }

void AzDrive::refresh(HostTime now) {
  const bool moving = axis_.moving(now);
  const bool homed = axis_.homed(now);
  const bool in_position = axis_.in_position(now);
  const bool alarm = alarm_ != 0;
  const unsigned output = (homed ? bit::kHomeEnd : 0U) | (ready(now) ? bit::kReady : 0U) | (alarm ? bit::kAlarmA : 0U) |
                          (moving ? bit::kBusy | bit::kMove : 0U) | (in_position ? bit::kInPosition : 0U);
  registers_[reg::kOutput + 1] = static_cast<std::uint16_t>(output);
  set_long(reg::kAlarm, alarm_);
  set_long(reg::kCommandPosition, axis_.command_steps(now));
  set_long(reg::kCommandPosition32, axis_.command_steps(now));
  const std::int32_t actual = axis_.encoder_steps(now);
  set_long(reg::kActualPosition, actual);
  set_long(reg::kActualPosition32, actual);
  set_long(reg::kDriverTemperature, 412);
  set_long(reg::kMotorTemperature, 385);
  // Signal n of the fixed image is bit n % 16 of word n / 16.
  registers_[reg::kFixedImage] = homed ? 1U : 0U;
  registers_[reg::kFixedImage + 1] =
      static_cast<std::uint16_t>((alarm ? 1U << 1U : 1U << 2U) | (1U << 3U) | (ready(now) ? 1U << 4U : 0U) |
                                 (moving ? 1U << 6U | 1U << 8U : 0U) | (in_position ? 1U << 10U : 0U));
}

ModbusException AzDrive::read(int address, std::span<std::uint16_t> values) {
  if (address + static_cast<int>(values.size()) > kRegisters) return ModbusException::kIllegalAddress;
  refresh(HostClock::now());
  std::copy_n(registers_.begin() + address, values.size(), values.begin());
  return ModbusException::kNone;
}

ModbusException AzDrive::write(int address, std::span<const std::uint16_t> values) {
  const int end = address + static_cast<int>(values.size());
  if (end > kRegisters) return ModbusException::kIllegalAddress;
  const auto is_read_only = [](int at) { return at >= reg::kOutput && at < reg::kFixedImage + 8; };
  if (is_read_only(address) || is_read_only(end - 1)) return ModbusException::kIllegalAddress;
  const unsigned level_before = registers_[reg::kInputLevel + 1];
  std::copy(values.begin(), values.end(), registers_.begin() + address);
  const HostTime now = HostClock::now();
  written(address, values.size(), now);
  const unsigned auto_off = registers_[reg::kInputAutoOff + 1];
  registers_[reg::kInputAutoOff + 1] = 0;
  act_on_inputs(auto_off | (registers_[reg::kInputLevel + 1] & ~level_before), now);
  return ModbusException::kNone;
}

void AzDrive::written(int address, std::size_t count, HostTime now) {
  const int end = address + static_cast<int>(count);
  const auto touches = [&](int at) { return address <= at + 1 && end > at; };
  if (touches(reg::kAlarmReset) && long_at(reg::kAlarmReset) == 1) {
    alarm_ = 0;
    set_long(reg::kAlarmReset, 0);
  }
  if (address > reg::kDirectLast || end <= reg::kDirectFirst) return;
  const std::int32_t trigger = long_at(reg::kDirectTrigger);
  // Trigger 1 starts when it is written; -n keeps standing and starts whenever item n (counted back from the trigger)
  // is.
  const bool started_by_trigger = trigger == 1 && touches(reg::kDirectTrigger);
  const bool started_by_item =
      trigger <= -1 && trigger >= -7 && touches(reg::kDirectTrigger + 2 * trigger) && !touches(reg::kDirectTrigger);
  if (started_by_trigger) set_long(reg::kDirectTrigger, 0);
  if (started_by_trigger || started_by_item) start_direct_operation(now);
}

void AzDrive::act_on_inputs(unsigned rising, HostTime now) {
  if ((rising & bit::kStop) != 0) axis_.stop(now);
  if ((rising & bit::kAlarmReset) != 0) alarm_ = 0;
  if ((rising & bit::kHome) != 0 && (rising & bit::kStop) == 0 && ready(now)) axis_.home(now);
}

bool AzDrive::leaves_limits(std::int32_t target, HostTime now) const {
  return long_at(reg::kLimitAction) == 1 && axis_.homed(now) &&
         (target > long_at(reg::kLimitPlus) || target < long_at(reg::kLimitMinus));
}

void AzDrive::start_direct_operation(HostTime now) {
  const std::int32_t type = long_at(reg::kDirectType);
  const bool stopped = (registers_[reg::kInputLevel + 1] & bit::kStop) != 0;
  // An absolute AZ move may be re-targeted while it runs; anything else needs READY.
  if (alarm_ != 0 || stopped || (axis_.moving(now) && type != kAbsolute)) return;
  int refused = refused_moves_.load();
  if (refused > 0 && refused_moves_.compare_exchange_strong(refused, refused - 1)) return;
  std::int32_t target = long_at(reg::kDirectPosition);
  if (type == kFromCommand) target += axis_.command_steps(now);
  if (type == kFromActual) target += axis_.encoder_steps(now);
  if (type != kAbsolute && type != kFromCommand && type != kFromActual) return;
  if (leaves_limits(target, now)) {
    alarm_ = kAlarmOvertravel;
    return;
  }
  const double speed = long_at(reg::kDirectSpeed);
  const double changing = long_at(reg::kDirectChanging);
  const double stopping = long_at(reg::kDirectStopping);
  if (speed <= 0 || changing <= 0 || stopping <= 0) return;
  ++moves_;
  axis_.move_to(now, target, speed, changing, stopping);
}

void AzDrive::raise_alarm(int code) {
  alarm_ = code;
  axis_.stop(HostClock::now());
}

void AzDrive::refuse_moves(int count) { refused_moves_ = count; }

}  // namespace fvd::sim
