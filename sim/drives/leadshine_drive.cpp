#include "sim/drives/leadshine_drive.hpp"

#include <algorithm>
#include <limits>

namespace fvd::sim {

namespace {

namespace reg {
constexpr int kParametersEnd = 0x0200;
constexpr int kPulsesPerRev = 0x0001;
constexpr int kEnable = 0x000F;
constexpr int kMonitor = 0x1000;
constexpr int kMonitorCount = 0x50;
constexpr int kStatus = 0x1003;
constexpr int kCommandPosition = 0x1012;
constexpr int kFeedbackPosition = 0x1014;
constexpr int kControl = 0x1801;
constexpr int kSaved = 0x1901;
constexpr int kAlarm = 0x2203;
constexpr int kPrControl = 0x6000;
constexpr int kPrCount = 0x30;
constexpr int kTrigger = 0x6002;
constexpr int kLimitPlus = 0x6006;
constexpr int kLimitMinus = 0x6008;
constexpr int kPaths = 0x6200;
constexpr int kPathWords = 8;
constexpr int kPathCount = 16;
constexpr int kPath0Trigger = 0x6207;
}  // namespace reg

/// Words of a path.
namespace path {
constexpr int kMode = 0;
constexpr int kPosition = 1;
constexpr int kSpeed = 3;
constexpr int kAcceleration = 4;
constexpr int kDeceleration = 5;
}  // namespace path

namespace mode {
constexpr unsigned kKind = 0xFU;
constexpr unsigned kPosition = 1;
constexpr unsigned kSpeed = 2;
constexpr unsigned kHoming = 3;
constexpr unsigned kInterrupts = 1U << 4U;
constexpr unsigned kRelative = 1U << 6U;
}  // namespace mode

namespace bit {
constexpr unsigned kFault = 1U << 0U;
constexpr unsigned kEnabled = 1U << 1U;
constexpr unsigned kRunning = 1U << 2U;
constexpr unsigned kCommandDone = 1U << 4U;
constexpr unsigned kPathDone = 1U << 5U;
constexpr unsigned kHomed = 1U << 6U;
constexpr unsigned kLimitsOn = 1U << 1U;
}  // namespace bit

constexpr int kAlarmLimit = 0x260;
constexpr int kAlarmTorqueOff = 0x570;
constexpr auto kJogLife = std::chrono::milliseconds(50);
constexpr double kJogRpm = 60.0;
constexpr double kJogRamp = 100.0;  // ms per 1000 rpm
constexpr std::int64_t kJogTarget_steps = std::numeric_limits<std::int32_t>::max();

}  // namespace

LeadshineDrive::LeadshineDrive(AxisModel& axis, DriveClock clock, int pulses_per_rev)
    : SimDrive(axis, std::move(clock)), pulses_per_rev_(std::clamp(pulses_per_rev, 1, 65535)) {
  using enum RegisterImage::Access;
  image().add_area(0, reg::kParametersEnd, kReadWrite);
  image().add_area(reg::kMonitor, reg::kMonitorCount, kReadOnly);
  image().add_area(reg::kControl, 1, kReadWrite);
  image().add_area(reg::kSaved, 1, kReadOnly);
  image().add_area(reg::kAlarm, 1, kReadOnly);
  image().add_area(reg::kPrControl, reg::kPrCount, kReadWrite);
  image().add_area(reg::kPaths, reg::kPathWords * reg::kPathCount, kReadWrite);
  power_on();
}

void LeadshineDrive::power_on() {
  image().set_word(reg::kPulsesPerRev, static_cast<unsigned>(pulses_per_rev_));
  path_ = 0;
  homing_ = false;
  jog_until_.reset();
}

ModbusException LeadshineDrive::may_read(int address, std::size_t count) const {
  if (address < reg::kParametersEnd && count > 1 && address % 2 != 0) return ModbusException::kIllegalAddress;
  return SimDrive::may_read(address, count);
}

ModbusException LeadshineDrive::may_write(int address, std::span<const std::uint16_t> values) const {
  const bool is_alone = values.size() == 1;
  if (address < reg::kParametersEnd && is_alone != (address % 2 != 0)) return ModbusException::kIllegalAddress;
  return SimDrive::may_write(address, values);
}

bool LeadshineDrive::enabled() const { return image().word(reg::kEnable) == 1 && alarm() == 0; }

void LeadshineDrive::refresh(HostTime now) {
  const bool moving = reports_motion(now);
  const bool done = !moving && reports_in_position(now);
  image().set_word(reg::kStatus, (alarm() != 0 ? bit::kFault : 0U) | (enabled() ? bit::kEnabled : 0U) |
                                     (moving ? bit::kRunning : 0U) | (moving ? 0U : bit::kCommandDone) |
                                     (done ? bit::kPathDone : 0U) | (axis().homed(now) ? bit::kHomed : 0U));
  image().set_value(reg::kCommandPosition, command_position(now));
  image().set_value(reg::kFeedbackPosition, actual_position(now));
  image().set_word(reg::kAlarm, static_cast<unsigned>(alarm()));
  const auto number = static_cast<unsigned>(path_);
  image().set_word(reg::kTrigger, moving ? (homing_ ? 0x20U : 0x0100U + number) : number);
}

void LeadshineDrive::was_read(int address, std::size_t count) {
  const Written read{address, static_cast<int>(count)};
  if (read.word(reg::kSaved)) image().set_word(reg::kSaved, 0);
}

void LeadshineDrive::was_written(const Written& written, HostTime now) {
  if (written.word(reg::kEnable) && !enabled()) halt(now);
  if (written.word(reg::kControl)) control(image().word(reg::kControl), now);
  if (written.word(reg::kTrigger)) trigger(image().word(reg::kTrigger), now);
  if (written.word(reg::kPath0Trigger)) trigger(image().word(reg::kPath0Trigger), now);
}

void LeadshineDrive::halt(HostTime now) {
  jog_until_.reset();
  if (axis().moving(now)) axis().stop(now);
}

void LeadshineDrive::trigger(unsigned command, HostTime now) {
  if (command == 0x40U) return halt(now);
  if (command == 0x21U && !axis().moving(now)) return preset_position(now, 0);
  if (!enabled()) return;
  if (command == 0x20U && !axis().moving(now)) {
    homing_ = start_home(now);
  } else if (command >= 0x10U && command <= 0x1FU) {
    start_path(static_cast<int>(command - 0x10U), now);
  }
}

void LeadshineDrive::start_path(int number, HostTime now) {
  const int at = reg::kPaths + reg::kPathWords * number;
  const unsigned kind = image().word(at + path::kMode);
  if (axis().moving(now) && (kind & mode::kInterrupts) == 0) return;
  path_ = number;
  homing_ = false;
  jog_until_.reset();
  const auto rpm = static_cast<std::int16_t>(image().word(at + path::kSpeed));
  if ((kind & mode::kKind) == mode::kHoming) {
    homing_ = start_home(now);
  } else if ((kind & mode::kKind) == mode::kSpeed) {
    start_move(now, rpm > 0 ? kJogTarget_steps : -kJogTarget_steps, steps_per_s(std::abs(rpm)),
               steps_per_s2(image().word(at + path::kAcceleration)),
               steps_per_s2(image().word(at + path::kDeceleration)));
  } else if ((kind & mode::kKind) == mode::kPosition) {
    start_position(at, kind, steps_per_s(rpm), now);
  }
}

void LeadshineDrive::start_position(int at, unsigned kind, double speed, HostTime now) {
  std::int64_t target = image().value(at + path::kPosition);
  if ((kind & mode::kRelative) != 0) target += command_position(now);
  const bool limits = (image().word(reg::kPrControl) & bit::kLimitsOn) != 0;
  if (limits && (target > image().value(reg::kLimitPlus) || target < image().value(reg::kLimitMinus))) {
    set_alarm(kAlarmLimit);
    return halt(now);
  }
  start_move(now, target, speed, steps_per_s2(image().word(at + path::kAcceleration)),
             steps_per_s2(image().word(at + path::kDeceleration)));
}

void LeadshineDrive::control(unsigned command, HostTime now) {
  if (command == 0x1111U) set_alarm(0);
  if (command == 0x2211U) image().set_word(reg::kSaved, 0x5555U);
  if (command == 0x4001U) jog(1, now);
  if (command == 0x4002U) jog(-1, now);
  image().set_word(reg::kControl, 0);
}

void LeadshineDrive::jog(int direction, HostTime now) {
  if (!enabled() || (axis().moving(now) && !jog_until_)) return;
  if (!jog_until_) {
    homing_ = false;
    const double ramp = steps_per_s2(kJogRamp);
    if (!start_move(now, direction * kJogTarget_steps, steps_per_s(kJogRpm), ramp, ramp)) return;
  }
  jog_until_ = now + kJogLife;
}

void LeadshineDrive::elapse(HostTime now) {
  if (!jog_until_ || now <= *jog_until_) return;
  axis().stop(*jog_until_);
  jog_until_.reset();
}

double LeadshineDrive::steps_per_s(double rpm) const { return rpm / 60.0 * image().word(reg::kPulsesPerRev); }

double LeadshineDrive::steps_per_s2(double ms_per_1000_rpm) const {
  const double rpm_per_s = 1e6 / std::max(1.0, ms_per_1000_rpm);
  return rpm_per_s / 60.0 * image().word(reg::kPulsesPerRev);
}

void LeadshineDrive::on_alarm(HostTime /*now*/) { jog_until_.reset(); }

void LeadshineDrive::on_limit(HostTime /*now*/) {
  jog_until_.reset();
  set_alarm(kAlarmLimit);
}

void LeadshineDrive::on_torque_off(HostTime /*now*/) {
  jog_until_.reset();
  set_alarm(kAlarmTorqueOff);
}

}  // namespace fvd::sim
