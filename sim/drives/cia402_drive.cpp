#include "sim/drives/cia402_drive.hpp"

namespace fvd::sim {

namespace {

namespace reg {
constexpr int kRead = 5000;
constexpr int kReadCount = 8;
constexpr int kStatusword = 5000;
constexpr int kModeDisplay = 5001;
constexpr int kPosition = 5002;
constexpr int kInputs = 5005;
constexpr int kErrorCode = 5007;
constexpr int kWritten = 6000;
constexpr int kWrittenCount = 13;
constexpr int kControlword = 6000;
constexpr int kMode = 6001;
constexpr int kTarget = 6002;
constexpr int kVelocity = 6004;
constexpr int kAcceleration = 6009;
constexpr int kDeceleration = 6011;
}  // namespace reg

namespace control {
constexpr unsigned kSwitchOn = 1U << 0U;
constexpr unsigned kVoltage = 1U << 1U;
constexpr unsigned kNoQuickStop = 1U << 2U;
constexpr unsigned kEnable = 1U << 3U;
constexpr unsigned kNewSetPoint = 1U << 4U;  // in homing mode: start
constexpr unsigned kAtOnce = 1U << 5U;
constexpr unsigned kRelative = 1U << 6U;
constexpr unsigned kFaultReset = 1U << 7U;
constexpr unsigned kHalt = 1U << 8U;
}  // namespace control

namespace status {
constexpr unsigned kVoltage = 1U << 4U;
constexpr unsigned kRemote = 1U << 9U;
constexpr unsigned kTargetReached = 1U << 10U;
constexpr unsigned kInternalLimit = 1U << 11U;
constexpr unsigned kAcknowledged = 1U << 12U;  // in homing mode: homing attained
}  // namespace status

constexpr unsigned kProfilePosition = 1;
constexpr unsigned kHoming = 6;

}  // namespace

Cia402Drive::Cia402Drive(AxisModel& axis, DriveClock clock) : SimDrive(axis, std::move(clock)) {
  using enum RegisterImage::Access;
  image().add_area(reg::kRead, reg::kReadCount, kReadOnly);
  image().add_area(reg::kWritten, reg::kWrittenCount, kReadWrite);
  power_on();
}

void Cia402Drive::power_on() {
  image().set_value(reg::kVelocity, 500);
  image().set_value(reg::kAcceleration, 500);
  image().set_value(reg::kDeceleration, 500);
  state_ = State::kSwitchOnDisabled;
  control_ = mode_ = 0;
  acknowledged_ = internal_limit_ = halted_ = false;
  running_.reset();
  buffered_.reset();
}

unsigned Cia402Drive::statusword(HostTime now) {
  unsigned word = status::kVoltage | status::kRemote;
  switch (state_) {
    case State::kSwitchOnDisabled:
      word |= 0x40U;
      break;
    case State::kReadyToSwitchOn:
      word |= 0x21U;
      break;
    case State::kSwitchedOn:
      word |= 0x23U;
      break;
    case State::kOperationEnabled:
      word |= 0x27U;
      break;
    case State::kQuickStopActive:
      word |= 0x07U;
      break;
    case State::kFault:
      word |= 0x08U;
      break;
  }
  if (reports_in_position(now) && !buffered_) word |= status::kTargetReached;
  if (internal_limit_) word |= status::kInternalLimit;
  if (mode_ == kHoming) {
    const auto latency = std::chrono::duration<double, std::milli>(axis().parameters().start_latency_ms);
    const bool is_stale = home_since_ != HostTime{} && now - home_since_ <= latency;
    if (axis().homed(now) && !reports_motion(now) && !is_stale) word |= status::kAcknowledged;
  } else if (acknowledged_) {
    word |= status::kAcknowledged;
  }
  return word;
}

void Cia402Drive::refresh(HostTime now) {
  image().set_word(reg::kStatusword, statusword(now));
  image().set_word(reg::kModeDisplay, mode_);
  image().set_value(reg::kPosition, actual_position(now));
  image().set_value(reg::kInputs, internal_limit_ ? (direction_ > 0 ? 2 : 1) : 0);
  image().set_word(reg::kErrorCode, static_cast<unsigned>(alarm()));
}

void Cia402Drive::was_written(const Written& written, HostTime now) {
  if (written.word(reg::kMode)) {
    const unsigned mode = image().word(reg::kMode) & 0xFFU;
    if (mode == kProfilePosition || mode == kHoming) mode_ = mode;
  }
  if (written.word(reg::kControlword)) control(image().word(reg::kControlword), now);
}

void Cia402Drive::elapse(HostTime now) {
  if (axis().moving(now)) return;
  if (state_ == State::kQuickStopActive) state_ = State::kSwitchOnDisabled;
  if (halted_) return;
  if (buffered_) {
    const SetPoint next = *buffered_;
    buffered_.reset();
    acknowledged_ = (control_ & control::kNewSetPoint) != 0;
    start(next, now);
  }
}

void Cia402Drive::control(unsigned word, HostTime now) {
  const unsigned rising = word & ~control_;
  const unsigned falling = control_ & ~word;
  control_ = word;
  const bool was_enabled = state_ == State::kOperationEnabled;
  if (state_ == State::kFault) {
    if ((rising & control::kFaultReset) != 0) {
      set_alarm(0);
      internal_limit_ = false;
      state_ = State::kSwitchOnDisabled;
    }
    return;
  }
  change_state(word, now);
  // An edge counts only if the drive was enabled before: 0x1F out of "switched on" enables and moves nothing.
  if (state_ != State::kOperationEnabled || !was_enabled) return;
  if (mode_ == kProfilePosition) position_mode(word, rising, falling, now);
  if (mode_ == kHoming) {
    if ((rising & control::kHalt) != 0 && axis().moving(now)) axis().stop(now);
    if ((rising & control::kNewSetPoint) != 0 && (word & control::kHalt) == 0) home(now);
  }
}

void Cia402Drive::change_state(unsigned word, HostTime now) {
  const auto is = [&](unsigned mask) { return (word & mask) == mask; };
  if (!is(control::kVoltage)) {
    leave_operation(State::kSwitchOnDisabled, now);
  } else if (!is(control::kNoQuickStop)) {
    if (state_ == State::kOperationEnabled) {
      leave_operation(State::kQuickStopActive, now);
    } else if (state_ != State::kQuickStopActive) {
      state_ = State::kSwitchOnDisabled;
    }
  } else if (state_ == State::kQuickStopActive || (is(control::kSwitchOn) && state_ == State::kSwitchOnDisabled)) {
    return;  // on its way to "switch on disabled", or there, which "ready to switch on" has to follow
  } else if (!is(control::kSwitchOn)) {
    leave_operation(State::kReadyToSwitchOn, now);
  } else if (!is(control::kEnable)) {
    leave_operation(State::kSwitchedOn, now);
  } else {
    state_ = State::kOperationEnabled;
  }
}

void Cia402Drive::leave_operation(State next, HostTime now) {
  if (state_ == State::kOperationEnabled && axis().moving(now)) axis().stop(now);
  state_ = next;
  running_.reset();
  buffered_.reset();
  acknowledged_ = halted_ = false;
}

void Cia402Drive::position_mode(unsigned word, unsigned rising, unsigned falling, HostTime now) {
  if ((rising & control::kHalt) != 0) {
    halted_ = true;
    if (axis().moving(now)) {
      axis().stop(now);
    } else {
      running_.reset();  // it had ended
    }
  }
  if ((falling & control::kHalt) != 0) {
    halted_ = false;
    if (running_) start(*running_, now);
  }
  if ((rising & control::kNewSetPoint) != 0) take_set_point(word, now);
  if ((word & control::kNewSetPoint) == 0 && !buffered_) acknowledged_ = false;
}

void Cia402Drive::take_set_point(unsigned word, HostTime now) {
  const bool waits = halted_ || (axis().moving(now) && (word & control::kAtOnce) == 0);
  if (waits && buffered_) return;  // no room: bit 12 stays set, which says so
  const auto unsigned_at = [&](int at) { return static_cast<double>(static_cast<std::uint32_t>(image().value(at))); };
  const SetPoint set_point{.target = image().value(reg::kTarget),
                           .relative = (word & control::kRelative) != 0,
                           .speed = unsigned_at(reg::kVelocity),
                           .acceleration = unsigned_at(reg::kAcceleration),
                           .deceleration = unsigned_at(reg::kDeceleration)};
  acknowledged_ = true;
  if (waits) {
    buffered_ = set_point;
  } else {
    buffered_.reset();
    start(set_point, now);
  }
}

void Cia402Drive::start(const SetPoint& set_point, HostTime now) {
  SetPoint absolute = set_point;
  const std::int64_t from = command_position(now);
  if (absolute.relative) absolute.target += from;
  absolute.relative = false;
  if (!start_move(now, absolute.target, absolute.speed, absolute.acceleration, absolute.deceleration)) return;
  running_ = absolute;
  internal_limit_ = false;
  direction_ = absolute.target >= from ? 1 : -1;
}

void Cia402Drive::home(HostTime now) {
  if (axis().moving(now) || !start_home(now)) return;
  running_.reset();
  internal_limit_ = false;
  home_since_ = now;
}

void Cia402Drive::on_alarm(HostTime now) { leave_operation(State::kFault, now); }

void Cia402Drive::on_limit(HostTime /*now*/) {
  running_.reset();
  buffered_.reset();
  internal_limit_ = true;
}

void Cia402Drive::on_torque_off(HostTime now) { leave_operation(State::kSwitchOnDisabled, now); }

}  // namespace fvd::sim
