#include "sim/drives/sim_drive.hpp"

#include <algorithm>
#include <limits>

namespace fvd::sim {

namespace {

std::int32_t saturated(std::int64_t value) {
  using Limits = std::numeric_limits<std::int32_t>;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(value, Limits::min(), Limits::max()));
}

}  // namespace

HostTime SimDrive::time_passes() {
  const HostTime now = clock_();
  if (last_request_ == HostTime::max()) last_request_ = now;
  elapse(now);
  return now;
}

ModbusException SimDrive::read(int address, std::span<std::uint16_t> values) {
  const MutexLock lock(mutex_);
  const HostTime now = time_passes();
  last_request_ = now;
  const auto exception = may_read(address, values.size());
  if (exception != ModbusException::kNone) return exception;
  refresh(now);
  image_.copy_out(address, values);
  was_read(address, values.size());
  return ModbusException::kNone;
}

ModbusException SimDrive::write(int address, std::span<const std::uint16_t> values) {
  const MutexLock lock(mutex_);
  const HostTime now = time_passes();
  last_request_ = now;
  const auto exception = may_write(address, values);
  if (exception != ModbusException::kNone) return exception;
  image_.copy_in(address, values);
  was_written({address, static_cast<int>(values.size())}, now);
  return ModbusException::kNone;
}

void SimDrive::idle() {
  const MutexLock lock(mutex_);
  time_passes();
}

ModbusException SimDrive::may_read(int address, std::size_t count) const {
  mutex_.assert_held();
  return image_.readable(address, count) ? ModbusException::kNone : ModbusException::kIllegalAddress;
}

ModbusException SimDrive::may_write(int address, std::span<const std::uint16_t> values) const {
  mutex_.assert_held();
  return image_.writable(address, values.size()) ? ModbusException::kNone : ModbusException::kIllegalAddress;
}

void SimDrive::raise_alarm(int code) {
  const MutexLock lock(mutex_);
  const HostTime now = time_passes();
  alarm_ = code;
  axis_.stop(now);
  on_alarm(now);
}

void SimDrive::limit_hit() {
  const MutexLock lock(mutex_);
  const HostTime now = time_passes();
  axis_.stop(now);
  on_limit(now);
}

void SimDrive::emergency_stop() {
  const MutexLock lock(mutex_);
  const HostTime now = time_passes();
  axis_.stop(now);
  on_torque_off(now);
}

void SimDrive::power_cycle() {
  const MutexLock lock(mutex_);
  const HostTime now = time_passes();
  axis_.power_cycle(now);
  alarm_ = 0;
  offset_ = 0;
  held_until_ = HostTime::min();
  last_request_ = now;
  image_.clear();
  power_on();
}

void SimDrive::refuse_moves(int count) {
  const MutexLock lock(mutex_);
  refused_starts_ = count;
}

void SimDrive::hold_in_position(HostClock::duration duration) {
  const MutexLock lock(mutex_);
  held_until_ = clock_() + duration;
}

void SimDrive::exchange_words(bool exchanged) {
  const MutexLock lock(mutex_);
  image_.set_low_word_first(low_word_first_ != exchanged);
}

void SimDrive::set_low_word_first() {
  const MutexLock lock(mutex_);
  low_word_first_ = true;
  image_.set_low_word_first(true);
  image_.clear();
  power_on();
}

bool SimDrive::axis_moves() {
  const MutexLock lock(mutex_);
  return axis_.moving(clock_());
}

bool SimDrive::reports_motion(HostTime now) const {
  mutex_.assert_held();
  return !is_held(now) && axis_.moving(now);
}

bool SimDrive::reports_in_position(HostTime now) const {
  mutex_.assert_held();
  return is_held(now) || axis_.in_position(now);
}

std::int32_t SimDrive::command_position(HostTime now) const {
  mutex_.assert_held();
  return saturated(axis_.command_steps(now) + offset_);
}

std::int32_t SimDrive::actual_position(HostTime now) const {
  mutex_.assert_held();
  return saturated(axis_.encoder_steps(now) + offset_);
}

void SimDrive::preset_position(HostTime now, std::int32_t position) {
  mutex_.assert_held();
  offset_ = std::int64_t{position} - axis_.command_steps(now);
}

bool SimDrive::refuses_start() {
  if (refused_starts_ == 0) return false;
  --refused_starts_;
  return true;
}

bool SimDrive::start_move(HostTime now, std::int64_t target, double speed, double acceleration, double deceleration) {
  mutex_.assert_held();
  if (!(speed > 0) || !(acceleration > 0) || !(deceleration > 0) || refuses_start()) return false;
  ++moves_;
  axis_.move_to(now, saturated(target - offset_), speed, acceleration, deceleration);
  return true;
}

bool SimDrive::start_home(HostTime now) {
  mutex_.assert_held();
  if (refuses_start()) return false;
  offset_ = 0;
  axis_.home(now);
  return true;
}

}  // namespace fvd::sim
