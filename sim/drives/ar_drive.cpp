#include "sim/drives/ar_drive.hpp"

namespace fvd::sim {

namespace {

namespace reg {
constexpr int kInput = 0x007D;
constexpr int kOutput = 0x007F;
constexpr int kAlarm = 0x0080;
constexpr int kCommandPosition = 0x00C6;
constexpr int kActualPosition = 0x00CC;
constexpr int kMonitorFirst = 0x007E;
constexpr int kMonitorEnd = 0x0180;
constexpr int kAlarmReset = 0x0180;
constexpr int kPreset = 0x018A;
constexpr int kLimitAction = 0x0386;
constexpr int kLimitPlus = 0x0388;
constexpr int kLimitMinus = 0x038A;
constexpr int kPosition = 0x0400;
constexpr int kSpeed = 0x0480;
constexpr int kMode = 0x0500;
constexpr int kAcceleration = 0x0600;
constexpr int kDeceleration = 0x0680;
constexpr int kDataEnd = 0x0700;
constexpr int kTimeout = 0x1200;
constexpr int kTimeoutCount = 4;
}  // namespace reg

namespace bit {
constexpr unsigned kNumber = 7U;
constexpr unsigned kStart = 1U << 3U;
constexpr unsigned kHome = 1U << 4U;
constexpr unsigned kStop = 1U << 5U;
constexpr unsigned kFree = 1U << 6U;
constexpr unsigned kHomeP = 1U << 4U;
constexpr unsigned kReady = 1U << 5U;
constexpr unsigned kAlarm = 1U << 7U;
constexpr unsigned kBusy = 1U << 8U;
constexpr unsigned kMove = 1U << 13U;
constexpr unsigned kEnd = 1U << 14U;
}  // namespace bit

constexpr int kData = 64;
constexpr int kAlarmLimitSwitch = 0x66;
constexpr int kAlarmOvertravel = 0x67;
constexpr int kAlarmTorqueOff = 0x68;
constexpr int kAlarmCommunication = 0x85;

}  // namespace

ArDrive::ArDrive(AxisModel& axis, DriveClock clock) : SimDrive(axis, std::move(clock)) {
  using enum RegisterImage::Access;
  image().add_area(0, reg::kDataEnd, kReadWrite);
  image().add_area(reg::kMonitorFirst, reg::kMonitorEnd - reg::kMonitorFirst, kReadOnly);
  image().add_area(reg::kTimeout, reg::kTimeoutCount, kReadWrite);
  power_on();
}

void ArDrive::power_on() {
  for (int n = 0; n < kData; ++n) {
    image().set_value(reg::kSpeed + 2 * n, 1000);
    image().set_value(reg::kAcceleration + 2 * n, 30000);
    image().set_value(reg::kDeceleration + 2 * n, 30000);
  }
  level_ = pending_ = 0;
  reset_set_ = preset_set_ = false;
}

void ArDrive::refresh(HostTime now) {
  const bool moving = reports_motion(now);
  const bool is_ready = alarm() == 0 && !moving && (level_ & (bit::kStop | bit::kFree)) == 0;
  image().set_word(reg::kOutput, (axis().homed(now) ? bit::kHomeP : 0U) | (is_ready ? bit::kReady : 0U) |
                                     (alarm() != 0 ? bit::kAlarm : 0U) | (moving ? bit::kBusy | bit::kMove : 0U) |
                                     (reports_in_position(now) ? bit::kEnd : 0U));
  image().set_value(reg::kAlarm, alarm());
  image().set_value(reg::kCommandPosition, command_position(now));
  image().set_value(reg::kActualPosition, actual_position(now));
}

bool ArDrive::ready(HostTime now) {
  return alarm() == 0 && !axis().moving(now) && (level_ & (bit::kStop | bit::kFree)) == 0;
}

bool ArDrive::rises(int address, const Written& written, bool& was_set) {
  if (!written.value(address)) return false;
  const bool is_set = image().value(address) == 1;
  const bool risen = is_set && !was_set;
  was_set = is_set;
  return risen;
}

void ArDrive::was_written(const Written& written, HostTime now) {
  if (rises(reg::kAlarmReset, written, reset_set_)) set_alarm(0);
  if (rises(reg::kPreset, written, preset_set_) && !axis().moving(now)) preset_position(now, 0);
  if (written.word(reg::kInput)) see_inputs(now);
}

void ArDrive::see_inputs(HostTime now) {
  const unsigned level = image().word(reg::kInput);
  const unsigned rising = level & ~level_;
  level_ = level;
  if ((level & (bit::kStop | bit::kFree)) != 0 && axis().moving(now)) axis().stop(now);
  pending_ &= level;  // let go too early
  if ((rising & (bit::kStart | bit::kHome)) != 0) {
    pending_ |= rising & (bit::kStart | bit::kHome);
    risen_ = now;
  }
}

void ArDrive::elapse(HostTime now) {
  if (pending_ != 0 && now - risen_ >= kMinHoldTime) {
    const HostTime seen = risen_ + kMinHoldTime;
    const unsigned inputs = pending_;
    pending_ = 0;
    if (ready(seen)) {
      if ((inputs & bit::kHome) != 0) {
        start_home(seen);
      } else {
        start_operation(seen);
      }
    }
  }
  watch_communication(now);
}

void ArDrive::watch_communication(HostTime now) {
  const std::chrono::milliseconds timeout(image().value(reg::kTimeout));
  if (timeout.count() <= 0 || alarm() != 0 || now - last_request() <= timeout) return;
  set_alarm(kAlarmCommunication);
  axis().stop(last_request() + timeout);
}

void ArDrive::start_operation(HostTime now) {
  const int at = 2 * static_cast<int>(level_ & bit::kNumber);
  std::int64_t target = image().value(reg::kPosition + at);
  if (image().value(reg::kMode + at) == 0) target += command_position(now);
  const bool limits = image().value(reg::kLimitAction) > 0 && axis().homed(now);
  if (limits && (target > image().value(reg::kLimitPlus) || target < image().value(reg::kLimitMinus))) {
    set_alarm(kAlarmOvertravel);
    return;
  }
  start_move(now, target, image().value(reg::kSpeed + at), image().value(reg::kAcceleration + at),
             image().value(reg::kDeceleration + at));
}

void ArDrive::on_limit(HostTime /*now*/) { set_alarm(kAlarmLimitSwitch); }

void ArDrive::on_torque_off(HostTime /*now*/) { set_alarm(kAlarmTorqueOff); }

}  // namespace fvd::sim
