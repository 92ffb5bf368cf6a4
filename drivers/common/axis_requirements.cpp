#include "drivers/common/axis_requirements.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "core/base/error.hpp"

namespace fvd {

namespace {

/// A position is not waited for any longer.
constexpr std::chrono::milliseconds kLongestLookAhead{2000};
/// A sweep has ended when the axis rests this close to its target, at the latest this long after its due time.
constexpr Micrometers kSweepWindow{5.0};
constexpr std::chrono::milliseconds kSweepGrace{3000};

void require_no_emergency_stop(const AxisPort& port, const AxisSample& sample) {
  if (!sample.emergency_stop) return;
  throw Error(ErrorCode::kStageAlarm, "the emergency stop of the drive at " + port.traits().address +
                                          " is on; release it, reset the alarm, and home again");
}

}  // namespace

StageInfo stage_info(const AxisTraits& traits, const AxisSettings& settings) {
  StageInfo info;
  info.name = traits.name;
  info.address = traits.address;
  info.feedback = traits.feedback;
  info.step_quantum = Micrometers{1.0 / std::abs(traits.steps_per_um)};
  info.feedback_resolution = traits.feedback_resolution;
  info.min = settings.min;
  info.max = settings.max;
  info.take_up = settings.take_up;
  info.lead = traits.lead;
  info.speed_um_per_s = settings.limits.speed_um_per_s;
  info.acceleration_um_per_s2 = settings.limits.acceleration_um_per_s2;
  info.simulated = settings.simulated;
  return info;
}

StageStatus stage_status(const AxisPort& port, const AxisSample& sample, std::vector<StageTemperature> temperatures) {
  StageStatus status;
  status.enabled = sample.enabled;
  status.homed = sample.homed;
  status.moving = sample.moving;
  status.in_position = sample.in_position;
  status.alarm = sample.alarm;
  status.alarm_code = sample.alarm_code;
  if (sample.alarm) status.alarm_text = port.alarm_text(sample.alarm_code);
  status.position = sample.position;
  status.sampled = sample.time;
  status.temperatures = std::move(temperatures);
  return status;
}

AxisState axis_state(const AxisSample& sample, AxisState commanded) {
  if (sample.alarm || sample.emergency_stop) return AxisState::kAlarm;
  if (commanded == AxisState::kHoming) return commanded;
  if (!sample.reports_rest()) return AxisState::kMoving;
  if (commanded == AxisState::kMoving) return AxisState::kSettling;
  if (!sample.enabled) return AxisState::kDisabled;
  return sample.homed ? AxisState::kReady : AxisState::kNotHomed;
}

bool obeys(const AxisSample& sample, const MoveRecord& move, const AxisSample& before,
           const SettleCriterion& criterion) {
  return sample.moving || abs(sample.position - move.target_quantised) <= criterion.window ||
         abs(sample.position - before.position) > criterion.window;
}

SettleCriterion end_of_sweep(const AxisSettings& settings, Micrometers distance, double speed_um_per_s) {
  const double seconds = abs(distance).value / speed_um_per_s + speed_um_per_s / settings.limits.acceleration_um_per_s2;
  return {kSweepWindow, 1, std::chrono::milliseconds(0),
          kSweepGrace + std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000.0))};
}

std::string not_settled_text(const MoveRecord& move, const AxisSample& sample, const SettleCriterion& criterion) {
  std::ostringstream message;
  message << "the axis did not settle within " << criterion.window.value << " um of " << move.target_quantised.value
          << " um in " << criterion.timeout.count() << " ms; ";
  const double off_um = std::abs((sample.position - move.target_quantised).value);
  if (off_um > criterion.window.value) {
    message << "it was at " << sample.position.value << " um";
    return message.str();
  }
  message << "it stands where it should, " << off_um << " um off, but ";
  if (sample.moving) {
    message << "the drive reports motion: does its servo hunt?";
  } else if (!sample.in_position) {
    message << "the drive does not report 'in position': widen its own window, or see to what makes it swing";
  } else {
    message << "it was not there for " << criterion.samples << " readings and " << criterion.dwell.count()
            << " ms in a row, of " << move.polls
            << " readings in all: the line is slow, or the axis swings; allow more time, or a wider window";
  }
  return message.str();
}

void require_wanted(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the axis was asked to stop");
}

void require_agreement(AxisPort& port, const std::stop_token& stop) {
  std::string all;
  for (const std::string& one : port.disagreements(stop)) all += (all.empty() ? "" : "; ") + one;
  if (all.empty()) return;
  throw Error(ErrorCode::kBadConfig, "the drive at " + port.traits().address + " disagrees with its profile '" +
                                         port.traits().name + "': " + all +
                                         ". Nothing was moved; 'fvdctl stage check' shows all that it reads");
}

void throw_forgotten(const AxisTraits& traits, const std::string& what) {
  throw Error(ErrorCode::kStageNotHomed, "the drive at " + traits.address +
                                             " has forgotten its last target, as after a power cut" + what +
                                             "; home again");
}

void throw_foreign(const AxisTraits& traits, const ForeignWrite& foreign) {
  if (foreign.is_restart) throw_forgotten(traits, " (" + foreign.what + ")");
  throw Error(ErrorCode::kStageTaken, "another master writes to the drive at " + traits.address + ": " + foreign.what +
                                          "; fvd moves nothing: end that program and see to the part, then " +
                                          (traits.tells_homed ? "wait ten seconds" : "home after ten seconds"));
}

bool may_be_anothers_doing(ErrorCode code) {
  return code == ErrorCode::kStagePosition || code == ErrorCode::kTimeout || code == ErrorCode::kStageAlarm ||
         code == ErrorCode::kStageNotHomed;
}

void throw_not_begun(const AxisTraits& traits, Micrometers target) {
  throw Error(ErrorCode::kStagePosition, "the drive at " + traits.address + " took the move to " +
                                             std::to_string(target.value) +
                                             " um without a word and does not move: is it ready and enabled?");
}

void throw_disabled(const AxisTraits& traits) {
  throw Error(ErrorCode::kStageAlarm,
              "the drive at " + traits.address +
                  " was disabled, and not by fvd: an emergency stop or a power cut? See to it, then home again");
}

void throw_not_homed_in_time(const AxisTraits& traits) {
  throw Error(ErrorCode::kTimeout, "homing of " + traits.address + " did not end within " +
                                       std::to_string(traits.home_timeout.count()) +
                                       " ms; the axis was told to stop: check the home sensor and the timing");
}

void require_near(const AxisTraits& traits, HostTime time) {
  const auto ahead = std::chrono::duration_cast<std::chrono::milliseconds>(time - HostClock::now());
  if (ahead <= kLongestLookAhead) return;
  throw Error(ErrorCode::kCameraFramesLost, "the position of the axis at " + traits.address +
                                                " was asked for at a time " + std::to_string(ahead.count()) +
                                                " ms ahead; is the camera's clock right?");
}

const AxisTraits& require_limits_inside(const AxisTraits& traits, const AxisSettings& settings) {
  if (!traits.limits) return traits;
  const auto& [lower, upper] = *traits.limits;
  if (settings.min >= lower && settings.max <= upper) return traits;
  std::ostringstream message;
  message << "the configured limits of " << settings.min.value << ".." << settings.max.value
          << " um reach beyond the drive's own, " << lower.value << ".." << upper.value
          << " um: narrow /stage/min_um and max_um, or widen the drive's";
  throw Error(ErrorCode::kStageLimit, message.str());
}

StageCounts quantise(const AxisTraits& traits, Micrometers target) {
  const double steps = std::round(target.value * traits.steps_per_um);
  if (!(std::abs(steps) <= std::numeric_limits<std::int32_t>::max())) {
    throw Error(ErrorCode::kStageLimit,
                "a target of " + std::to_string(target.value) + " um is beyond the drive's counter");
  }
  return {static_cast<std::int32_t>(steps)};
}

void require_within_limits(const AxisSettings& settings, Micrometers target) {
  if (target >= settings.min && target <= settings.max) return;
  std::ostringstream message;
  message << "a target of " << target.value << " um is outside the stage's limits of " << settings.min.value << ".."
          << settings.max.value << " um; nothing was moved";
  throw Error(ErrorCode::kStageLimit, message.str());
}

void require_sweep_speed(const AxisSettings& settings, double speed_um_per_s) {
  if (speed_um_per_s > 0.0 && speed_um_per_s <= settings.limits.speed_um_per_s) return;
  std::ostringstream message;
  message << "a sweep at " << speed_um_per_s << " um/s is outside 0.." << settings.limits.speed_um_per_s
          << " um/s, the speed of moves; nothing was moved";
  throw Error(ErrorCode::kStageLimit, message.str());
}

void require_homing_possible(const AxisPort& port, const AxisSample& sample) {
  require_no_emergency_stop(port, sample);
  if (!sample.limit_positive && !sample.limit_negative) require_no_alarm(port, sample);
}

void require_no_alarm(const AxisPort& port, const AxisSample& sample) {
  require_no_emergency_stop(port, sample);
  if (sample.alarm) {
    throw Error(ErrorCode::kStageAlarm, "the drive at " + port.traits().address + " reports " +
                                            port.alarm_text(sample.alarm_code) +
                                            "; clear the cause, then reset the alarm");
  }
}

void require_homed(const AxisTraits& traits, const AxisSample& sample) {
  if (sample.homed) return;
  throw Error(ErrorCode::kStageNotHomed, "no absolute move of " + traits.address + " before it is homed");
}

void require_reference_kept(const AxisTraits& traits, const AxisSample& sample) {
  if (sample.homed) return;
  throw Error(ErrorCode::kStageNotHomed,
              "the drive at " + traits.address + " lost its reference in the move, as after a power cut; home again");
}

void require_off_limits(const AxisTraits& traits, const AxisSample& sample) {
  if (!sample.limit_positive && !sample.limit_negative) return;
  throw Error(ErrorCode::kStageLimit, "the axis at " + traits.address + " stands on its " +
                                          (sample.limit_positive ? "positive" : "negative") +
                                          " limit switch; move it away by hand, or home");
}

void require_done(const AxisTraits& traits, const CommandResult& result, const char* command) {
  if (result.outcome == CommandOutcome::kDone) return;
  const auto code =
      result.outcome == CommandOutcome::kRefused ? ErrorCode::kStagePosition : ErrorCode::kStageDisconnected;
  throw Error(code, "the drive at " + traits.address + " did not take '" + command + "': " + result.error);
}

}  // namespace fvd
