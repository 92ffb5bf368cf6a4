#include "sim/drives/scl_drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fvd::sim {

namespace {

namespace reg {
constexpr int kAlarm = 0;
constexpr int kStatus = 1;
constexpr int kEncoder = 4;
constexpr int kImmediate = 6;
constexpr int kTarget = 8;
constexpr int kTemperature = 12;
constexpr int kPositionError = 14;
constexpr int kMonitorCount = 16;
constexpr int kAcceleration = 27;
constexpr int kDeceleration = 28;
constexpr int kSpeed = 29;
constexpr int kDistance = 30;
constexpr int kHalfGearing = 52;
constexpr int kOpcode = 124;
constexpr int kParameters = 125;
constexpr int kParameterCount = 5;
}  // namespace reg

namespace opcode {
constexpr unsigned kMoveRelative = 0x66;
constexpr unsigned kMoveAbsolute = 0x67;
constexpr unsigned kSeekHome = 0x6E;
constexpr unsigned kSetEncoder = 0x98;
constexpr unsigned kDisable = 0x9E;
constexpr unsigned kEnable = 0x9F;
constexpr unsigned kSetPosition = 0xA5;
constexpr unsigned kAlarmReset = 0xBA;
constexpr unsigned kFindHome = 0xDB;
constexpr unsigned kStop = 0xE1;
constexpr unsigned kStopNormal = 0xE2;
constexpr std::array kAll{kMoveRelative, kMoveAbsolute, kSeekHome, kSetEncoder, kDisable,   kEnable,
                          kSetPosition,  kAlarmReset,   kFindHome, kStop,       kStopNormal};
}  // namespace opcode

namespace bit {
constexpr unsigned kEnabled = 1U << 0U;
constexpr unsigned kFault = 1U << 2U;
constexpr unsigned kInPosition = 1U << 3U;
constexpr unsigned kMoving = 1U << 4U;
constexpr unsigned kAlarm = 1U << 9U;
constexpr unsigned kHoming = 1U << 10U;
}  // namespace bit

constexpr int kLimitCcw = 1 << 1;
constexpr int kLimitCw = 1 << 2;
constexpr int kMoveWhileDisabled = 1 << 12;
/// Position error, over-temperature, voltages, over-current, encoder.
constexpr int kFaults = (1 << 0) | (1 << 3) | (1 << 4) | (1 << 5) | (1 << 6) | (1 << 7) | (1 << 9);

constexpr double kAboveAxis = 21.2;  // K, the drive's electronics

constexpr unsigned kMaxAcceleration = 32767;
constexpr unsigned kMaxSpeed = 32000;
constexpr std::size_t kBufferSize = 16;

bool in_range(int address, unsigned value) {
  switch (address) {
    case reg::kAcceleration:
    case reg::kDeceleration:
      return value >= 1 && value <= kMaxAcceleration;
    case reg::kSpeed:
      return value >= 1 && value <= kMaxSpeed;
    case reg::kHalfGearing:
      return value >= 1;
    case reg::kOpcode:
      return std::find(opcode::kAll.begin(), opcode::kAll.end(), value) != opcode::kAll.end();
    default:
      return true;
  }
}

}  // namespace

SclDrive::SclDrive(AxisModel& axis, DriveClock clock, int steps_per_rev)
    : SimDrive(axis, std::move(clock)), steps_per_rev_(std::clamp(steps_per_rev, 2, 100000)) {
  using enum RegisterImage::Access;
  image().add_area(0, reg::kMonitorCount, kReadOnly);
  image().add_area(reg::kAcceleration, 5, kReadWrite);
  image().add_area(reg::kHalfGearing, 1, kReadWrite);
  image().add_area(reg::kOpcode, 1 + reg::kParameterCount, kReadWrite);
  power_on();
}

void SclDrive::power_on() {
  image().set_word(reg::kAcceleration, 600);
  image().set_word(reg::kDeceleration, 600);
  image().set_word(reg::kSpeed, 240);
  image().set_word(reg::kHalfGearing, static_cast<unsigned>(steps_per_rev_ / 2));
  enabled_ = true;
  homing_ = false;
  direction_ = 1;
  target_ = 0;
  buffered_.clear();
}

ModbusException SclDrive::may_read(int address, std::size_t count) const {
  return image().readable(address, count) ? ModbusException::kNone : ModbusException::kNotReadable;
}

ModbusException SclDrive::may_write(int address, std::span<const std::uint16_t> values) const {
  if (!image().writable(address, values.size())) return ModbusException::kNotWritable;
  for (const auto value : values) {
    if (!in_range(address++, value)) return ModbusException::kOutOfRange;
  }
  return ModbusException::kNone;
}

void SclDrive::refresh(HostTime now) {
  const bool moving = reports_motion(now);
  image().set_word(reg::kAlarm, static_cast<unsigned>(alarm()));
  image().set_word(reg::kStatus, (enabled_ ? bit::kEnabled : 0U) | ((alarm() & kFaults) != 0 ? bit::kFault : 0U) |
                                     (reports_in_position(now) ? bit::kInPosition : 0U) | (moving ? bit::kMoving : 0U) |
                                     (alarm() != 0 ? bit::kAlarm : 0U) | (homing_ && moving ? bit::kHoming : 0U));
  const std::int32_t actual = actual_position(now);
  const std::int32_t command = command_position(now);
  image().set_value(reg::kEncoder, actual);
  image().set_value(reg::kImmediate, command);
  image().set_value(reg::kTarget, static_cast<std::int32_t>(target_));
  image().set_value(reg::kPositionError, command - actual);
  image().set_word(reg::kTemperature,
                   static_cast<unsigned>(std::lround(10.0 * (axis().temperature_c(now) + kAboveAxis))));
}

void SclDrive::was_written(const Written& written, HostTime now) {
  if (!written.word(reg::kOpcode)) return;
  execute(image().word(reg::kOpcode), now);
}

void SclDrive::elapse(HostTime now) {
  if (buffered_.empty() || axis().moving(now)) return;
  const unsigned next = buffered_.front();
  buffered_.pop_front();
  start(next, now);
}

void SclDrive::halt(HostTime now) {
  buffered_.clear();
  if (axis().moving(now)) axis().stop(now);
}

void SclDrive::execute(unsigned code, HostTime now) {
  switch (code) {
    case opcode::kEnable:
      enabled_ = (alarm() & kFaults) == 0;
      return;
    case opcode::kDisable:
      enabled_ = false;
      return halt(now);
    case opcode::kAlarmReset:
      return set_alarm(0);
    case opcode::kStop:
    case opcode::kStopNormal:
      return halt(now);
    case opcode::kSetPosition:
      if (!axis().moving(now)) preset_position(now, image().value(reg::kParameters));
      return;
    case opcode::kMoveRelative:
    case opcode::kMoveAbsolute:
    case opcode::kSeekHome:
    case opcode::kFindHome:
      if (axis().moving(now) && buffered_.size() < kBufferSize) {
        buffered_.push_back(code);
      } else if (!axis().moving(now)) {
        start(code, now);
      }
      return;
    default:
      return;
  }
}

void SclDrive::start(unsigned code, HostTime now) {
  if (!enabled_) {
    set_alarm(alarm() | kMoveWhileDisabled);
    return;
  }
  if (alarm() != 0) return;
  if (code == opcode::kSeekHome || code == opcode::kFindHome) {
    homing_ = start_home(now);
    if (homing_) target_ = 0;
    return;
  }
  const double steps_per_rev = 2.0 * image().word(reg::kHalfGearing);
  const std::int64_t from = command_position(now);
  const std::int64_t wanted = image().value(reg::kDistance) + (code == opcode::kMoveRelative ? from : 0);
  const bool started = start_move(now, wanted, image().word(reg::kSpeed) / 240.0 * steps_per_rev,
                                  image().word(reg::kAcceleration) / 6.0 * steps_per_rev,
                                  image().word(reg::kDeceleration) / 6.0 * steps_per_rev);
  if (!started) return;
  homing_ = false;
  direction_ = wanted >= from ? 1 : -1;
  using Limits = std::numeric_limits<std::int32_t>;
  target_ = std::clamp<std::int64_t>(wanted, Limits::min(), Limits::max());
}

void SclDrive::on_alarm(HostTime /*now*/) {
  buffered_.clear();
  if ((alarm() & kFaults) != 0) enabled_ = false;
}

void SclDrive::on_limit(HostTime /*now*/) {
  buffered_.clear();
  set_alarm(alarm() | (direction_ > 0 ? kLimitCw : kLimitCcw));
}

void SclDrive::on_torque_off(HostTime /*now*/) {
  buffered_.clear();
  enabled_ = false;
}

}  // namespace fvd::sim
