#include "drivers/modbus/modbus_axis.hpp"

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/scan/settle_detector.hpp"
#include "drivers/modbus/axis_poller.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "drivers/modbus/modbus_link.hpp"

namespace fvd {

namespace {

/// A stop that got no answer is sent again: it does no harm twice.
constexpr int kStopAttempts = 3;
/// A sample of a resting axis counts as present for so long.
constexpr std::chrono::milliseconds kFresh{50};
/// A sweep has ended when the axis rests this close to its target, so long after its due time at the latest.
constexpr Micrometers kSweepWindow{5.0};
constexpr std::chrono::milliseconds kSweepPatience{3000};

class ModbusAxis final : public Axis {
 public:
  explicit ModbusAxis(const StageConfig& config)
      : config_(config), profile_(load_drive_profile(config.profile)), link_(modbus_link_config(config)) {
    identify();
    check_soft_limits();
    poller_ = std::make_unique<AxisPoller>(link_, profile_, config_.speed_um_per_s);
    enable({});
    arm_watchdog();
    state_ = AxisState::kReady;
  }

  ~ModbusAxis() override {
    if (profile_.watchdog && poller_->connected()) {
      (void)write(profile_.watchdog->reg, profile_.watchdog->disarmed);
    }
    poller_.reset();
    const ModbusLinkStats stats = link_.stats();
    spdlog::info(
        "stage link closed: {} transactions, {} retries, {} unknown, {} reconnects, {} bytes discarded, latency p50 "
        "{:.0f} us p99 {:.0f} us",
        stats.transactions, stats.retries, stats.unknown, stats.reconnects, stats.discarded_bytes, stats.latency_p50_us,
        stats.latency_p99_us);
  }

  [[nodiscard]] StageInfo info() const override {
    StageInfo info;
    info.name = profile_.name;
    info.address = link_.description();
    info.feedback = profile_.feedback;
    info.step_quantum = Micrometers{1.0 / profile_.steps_per_um};
    info.feedback_resolution = Micrometers{std::max(profile_.feedback_resolution_um, 1.0 / profile_.counts_per_um)};
    info.min = config_.min;
    info.max = config_.max;
    info.take_up = config_.take_up;
    info.lead = Micrometers{profile_.lead_um};
    info.speed_um_per_s = config_.speed_um_per_s;
    info.acceleration_um_per_s2 = config_.acceleration_um_per_s2;
    info.simulated = config_.simulated;
    return info;
  }

  [[nodiscard]] StageStatus status() override {
    const AxisSample sample = poller_->sample_after(HostClock::now(), {});
    StageStatus status;
    status.enabled = sample.enabled;
    status.homed = sample.homed;
    status.moving = sample.moving;
    status.in_position = sample.in_position;
    status.alarm = sample.alarm;
    status.alarm_code = sample.alarm_code;
    if (sample.alarm) status.alarm_text = alarm_text(profile_, sample.alarm_code);
    status.position = sample.position;
    status.temperatures = poller_->temperatures();
    status.state = state_of(sample);
    return status;
  }

  [[nodiscard]] std::optional<StageLinkStats> link_stats() const override {
    const ModbusLinkStats stats = link_.stats();
    return StageLinkStats{stats.transactions,   stats.retries,         stats.unknown,          stats.rejected,
                          stats.reconnects,     stats.discarded_bytes, poller_->implausible(), stats.latency_p50_us,
                          stats.latency_p99_us, stats.latency_max_us};
  }

  void home(std::stop_token stop) override {
    require_no_alarm(sample_after(HostClock::now(), stop));
    if (!sample_after(HostClock::now(), stop).enabled) enable(stop);
    const Doing homing(state_, AxisState::kHoming);
    target_.reset();
    const HostTime started = HostClock::now();
    poller_->remember_homed(false);
    const Outcome sent = run(profile_.home, "home", stop);
    halting_on_stop([&] {
      if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the axis was asked to stop");
    });
    require_done(sent);
    bool moved = false;
    for (HostTime last = HostClock::now();;) {
      const AxisSample sample = halting_on_stop([&] { return sample_after(last, stop); });
      last = sample.begun;
      if (!sample.limit_positive && !sample.limit_negative) require_no_alarm(sample);  // a reference may be a limit
      moved = moved || sample.moving || (profile_.homed && !sample.homed);
      // An axis that was homed and rests at its origin never shows motion: then the start time decides.
      const bool begun = moved || sample.time - started > profile_.start_within;
      if (begun && !sample.moving && (sample.homed || !profile_.homed)) {
        poller_->remember_homed(true);
        changed_ = HostClock::now();
        return;
      }
      if (sample.time - started > profile_.home_timeout) {
        this->stop();
        throw Error(ErrorCode::kTimeout,
                    "homing of " + link_.description() + " did not end within " +
                        std::to_string(profile_.home_timeout.count()) +
                        " ms; the axis was stopped: check the home sensor and the profile's timing");
      }
    }
  }

  MoveRecord move_to(Micrometers target, const SettleCriterion& criterion, std::stop_token stop) override {
    return move_at(config_.speed_um_per_s, target, criterion, stop);
  }

  MoveRecord sweep_to(Micrometers target, double speed_um_per_s, std::stop_token stop) override {
    if (!(speed_um_per_s > 0.0) || speed_um_per_s > config_.speed_um_per_s) {
      std::ostringstream message;
      message << "a sweep at " << speed_um_per_s << " um/s is outside 0.." << config_.speed_um_per_s
              << " um/s, the speed of moves; nothing was moved";
      throw Error(ErrorCode::kStageLimit, message.str());
    }
    const AxisSample here = sample_after(std::max(HostClock::now() - kFresh, changed_.load()), stop);
    const double seconds =
        abs(target - here.position).value / speed_um_per_s + speed_um_per_s / config_.acceleration_um_per_s2;
    const SettleCriterion rest{kSweepWindow, 1, std::chrono::milliseconds(0),
                               kSweepPatience + std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000.0))};
    return move_at(speed_um_per_s, target, rest, stop);
  }

  MoveRecord move_at(double speed_um_per_s, Micrometers target, const SettleCriterion& criterion,
                     std::stop_token stop) {
    MoveRecord move;
    move.target = target;
    move.target_counts = quantise(target);
    move.target_quantised = Micrometers{profile_.direction * move.target_counts.value / profile_.steps_per_um};
    require_within_limits(move.target_quantised);
    // The axis rests and is sampled all the time; what happens to it from now on, settle() sees.
    const AxisSample before = sample_after(std::max(HostClock::now() - kFresh, changed_.load()), stop);
    require_no_alarm(before);
    if (!before.homed) {
      throw Error(ErrorCode::kStageNotHomed, "no absolute move of " + link_.description() + " before it is homed");
    }
    require_enabled(before);
    if (!before.enabled) enable(stop);  // halted by our own stop, or back from an alarm: this is a new command
    require_reference(before);
    const Doing moving(state_, AxisState::kMoving);
    move.started = HostClock::now();
    start_move(move, speed_um_per_s, before, criterion, stop);
    halting_on_stop([&] { settle(move, before, criterion, stop); });
    return move;
  }

  [[nodiscard]] PositionMean mean_position(HostTime from, HostTime to) override {
    (void)sample_after(to, {});
    return poller_->mean(from, to);
  }

  [[nodiscard]] PositionMean position_at(HostTime at, std::chrono::microseconds reach) override {
    (void)sample_after(at + reach, {});
    return poller_->line(at, reach);
  }

  void stop() noexcept override {
    expect_enabled_ = false;  // some drives' quick stop ends in "disabled"
    try {
      SequenceResult result;
      for (int attempt = 0; attempt < kStopAttempts; ++attempt) {
        result = run_sequence(link_, profile_.stop, {}, ModbusPriority::kUrgent, {});
        changed_ = HostClock::now();
        if (result.outcome == ModbusOutcome::kOk) return;
      }
      spdlog::error("stage stop was not confirmed: {}", result.error);
    } catch (const std::exception& error) {
      spdlog::error("stage stop failed: {}", error.what());
    }
  }

  [[nodiscard]] bool connected() const noexcept override { return poller_->connected(); }

 private:
  // --- before anything may move ---

  /// A wrong device, or the right one with another register map, must not be moved.
  void identify() {
    const auto lookup = [this](const DriveRegister& reg) { return read_register(link_, reg); };
    for (const DriveIdentity& identity : profile_.identify) {
      const auto holds = identity.condition.holds(lookup);
      if (holds && *holds) continue;
      throw Error(ErrorCode::kStageDisconnected,
                  "the device at " + link_.description() + " is no " + profile_.name + ": " + identity.text +
                      (holds ? " reads otherwise" : " cannot be read") + "; is it the right profile and unit?");
    }
  }

  /// The configuration's limits lie within the drive's own.
  void check_soft_limits() {
    if (!profile_.soft_limits) return;
    const auto positive = read_register(link_, profile_.soft_limits->positive);
    const auto negative = read_register(link_, profile_.soft_limits->negative);
    if (!positive || !negative || *negative >= *positive) return;  // not set
    const double one = static_cast<double>(*positive) * profile_.direction / profile_.steps_per_um;
    const double other = static_cast<double>(*negative) * profile_.direction / profile_.steps_per_um;
    if (config_.min.value >= std::min(one, other) && config_.max.value <= std::max(one, other)) return;
    std::ostringstream message;
    message << "the configured limits of " << config_.min.value << ".." << config_.max.value
            << " um reach beyond the drive's own, " << std::min(one, other) << ".." << std::max(one, other)
            << " um: narrow /stage/min_um and max_um, or widen the drive's";
    throw Error(ErrorCode::kStageLimit, message.str());
  }

  void enable(std::stop_token stop) {
    require_done(run(profile_.enable, "enable", std::move(stop)));
    expect_enabled_ = true;
    changed_ = HostClock::now();
  }

  /// A drive that somebody else has disabled - an emergency stop, a power cut - may have been moved by hand since.
  void require_enabled(const AxisSample& sample) {
    if (sample.enabled || !expect_enabled_) return;
    expect_enabled_ = false;
    poller_->remember_homed(false);
    throw Error(ErrorCode::kStageAlarm,
                "the drive at " + link_.description() +
                    " was disabled, and not by fvd: an emergency stop or a power cut? See to it, then home again");
  }

  /// Drives that do not say whether they are homed forget their last target in a restart.
  void require_reference(const AxisSample& sample) {
    if (profile_.homed || !target_) return;
    auto read = sample.target;
    if (!read) read = read_register(link_, *profile_.target);
    if (!read || *read == *target_) return;
    poller_->remember_homed(false);
    target_.reset();
    throw Error(ErrorCode::kStageNotHomed, "the drive at " + link_.description() +
                                               " has forgotten its last target, as after a power cut; home again");
  }

  void arm_watchdog() {
    if (!profile_.watchdog) return;
    const ModbusReply reply = write(profile_.watchdog->reg, profile_.watchdog->armed);
    if (reply.outcome != ModbusOutcome::kOk) spdlog::warn("the drive's watchdog could not be armed: {}", reply.error);
  }

  ModbusReply write(const DriveRegister& reg, std::int64_t value) {
    return link_.write(reg.table, reg.address, encode(reg, value), ModbusPriority::kNormal, reg.write_single);
  }

  // --- looking ---

  AxisSample sample_after(HostTime after, std::stop_token stop) { return poller_->sample_after(after, stop); }

  [[nodiscard]] AxisState state_of(const AxisSample& sample) const {
    if (!poller_->connected()) return AxisState::kCommLost;
    if (sample.alarm || sample.emergency_stop) return AxisState::kAlarm;
    const AxisState doing = state_;
    if (doing == AxisState::kHoming) return doing;
    if (sample.moving) return AxisState::kMoving;
    if (doing == AxisState::kMoving) return AxisState::kSettling;
    if (!sample.enabled) return AxisState::kDisabled;
    return sample.homed ? AxisState::kReady : AxisState::kNotHomed;
  }

  /// What the axis is commanded to do, for as long as it is.
  class Doing {
   public:
    Doing(std::atomic<AxisState>& state, AxisState now) : state_(state) { state_ = now; }
    ~Doing() { state_ = AxisState::kReady; }
    Doing(const Doing&) = delete;
    Doing& operator=(const Doing&) = delete;

   private:
    std::atomic<AxisState>& state_;
  };

  /// Runs `wait`; an axis that moves is halted if a stop request or an error ends the wait.
  template <typename Wait>
  auto halting_on_stop(Wait wait) -> decltype(wait()) {
    try {
      return wait();
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kAborted) stop();
      throw;
    }
  }

  // --- moving ---

  [[nodiscard]] DriveValues values(StageCounts target, double speed_um_per_s) const {
    return {target.value, profile_.speed.value(speed_um_per_s),
            profile_.acceleration.value(config_.acceleration_um_per_s2)};
  }

  struct Outcome {
    SequenceResult result;
    const char* name;
  };
  Outcome run(const DriveSequence& sequence, const char* name, std::stop_token stop) {
    return {run_sequence(link_, sequence, values({}, config_.speed_um_per_s), ModbusPriority::kNormal, std::move(stop)),
            name};
  }

  /// For sequences whose repetition would do no harm: anything but "ok" is an error.
  void require_done(const Outcome& outcome) const {
    if (outcome.result.outcome == ModbusOutcome::kOk) return;
    const auto code =
        outcome.result.outcome == ModbusOutcome::kRejected ? ErrorCode::kStagePosition : ErrorCode::kStageDisconnected;
    throw Error(
        code, "the drive at " + link_.description() + " did not take '" + outcome.name + "': " + outcome.result.error);
  }

  [[nodiscard]] StageCounts quantise(Micrometers target) const {
    const double steps = std::round(target.value * profile_.steps_per_um) * profile_.direction;
    if (!(std::abs(steps) <= std::numeric_limits<std::int32_t>::max())) {
      throw Error(ErrorCode::kStageLimit,
                  "a target of " + std::to_string(target.value) + " um is beyond the drive's counter");
    }
    return {static_cast<std::int32_t>(steps)};
  }

  void require_within_limits(Micrometers target) const {
    if (target >= config_.min && target <= config_.max) return;
    std::ostringstream message;
    message << "a target of " << target.value << " um is outside the stage's limits of " << config_.min.value << ".."
            << config_.max.value << " um; nothing was moved";
    throw Error(ErrorCode::kStageLimit, message.str());
  }

  void require_no_alarm(const AxisSample& sample) const {
    if (sample.emergency_stop) {
      throw Error(ErrorCode::kStageAlarm, "the emergency stop of the drive at " + link_.description() +
                                              " is on; release it, reset the alarm, and home again");
    }
    if (sample.alarm) {
      throw Error(ErrorCode::kStageAlarm, "the drive at " + link_.description() + " reports " +
                                              alarm_text(profile_, sample.alarm_code) +
                                              "; clear the cause, then reset the alarm");
    }
    if (sample.limit_positive || sample.limit_negative) {
      throw Error(ErrorCode::kStageLimit, "the axis at " + link_.description() + " stands on its " +
                                              (sample.limit_positive ? "positive" : "negative") +
                                              " limit switch; move it away by hand, or home");
    }
  }

  /// Sends the move. Without a usable answer it looks whether the axis obeys, and only if it does not, sends the same
  /// absolute target once more: an absolute move that did arrive is not repeated by that.
  void start_move(const MoveRecord& move, double speed_um_per_s, const AxisSample& before,
                  const SettleCriterion& criterion, std::stop_token stop) {
    const DriveValues sent = values(move.target_counts, speed_um_per_s);
    for (int attempt = 1;; ++attempt) {
      const SequenceResult result = [&] {
        const auto paused = poller_->pause();
        return run_sequence(link_, profile_.move_absolute, sent, ModbusPriority::kNormal, stop);
      }();
      target_ = move.target_counts.value;
      if (result.outcome == ModbusOutcome::kOk) return;
      if (stop.stop_requested()) {
        this->stop();
        throw Error(ErrorCode::kAborted, "the axis was asked to stop");
      }
      if (result.outcome == ModbusOutcome::kRejected) {
        throw Error(ErrorCode::kStagePosition,
                    "the drive at " + link_.description() + " refused the move: " + result.error);
      }
      spdlog::warn("no answer to a move to {} um: {}", move.target.value, result.error);
      if (has_begun(move, before, criterion, stop)) {
        finish_start(result.step + 1, sent, stop);
        return;
      }
      if (attempt == 2) {
        throw Error(ErrorCode::kStageDisconnected, "the drive at " + link_.description() + " answers no move command");
      }
    }
  }

  /// The rest of a start whose decisive step was executed but not answered: edges are to be taken back.
  void finish_start(std::size_t first, const DriveValues& sent, std::stop_token stop) {
    const SequenceResult rest = run_sequence(link_, profile_.move_absolute, sent, ModbusPriority::kNormal, stop, first);
    if (rest.outcome != ModbusOutcome::kOk) spdlog::warn("the start of a move could not be completed: {}", rest.error);
  }

  [[nodiscard]] bool obeys(const AxisSample& sample, const MoveRecord& move, const AxisSample& before,
                           const SettleCriterion& criterion) const {
    return sample.moving || abs(sample.position - move.target_quantised) <= criterion.window ||
           abs(sample.position - before.position) > criterion.window;
  }

  bool has_begun(const MoveRecord& move, const AxisSample& before, const SettleCriterion& criterion,
                 std::stop_token stop) {
    const HostTime started = HostClock::now();
    for (HostTime last = started;;) {
      const AxisSample sample = halting_on_stop([&] { return sample_after(last, stop); });
      last = sample.begun;
      if (obeys(sample, move, before, criterion)) return true;
      if (sample.time - started > profile_.start_within) return false;
    }
  }

  void settle(MoveRecord& move, const AxisSample& before, const SettleCriterion& criterion, std::stop_token stop) {
    SettleDetector detector(move.target_quantised, criterion);
    bool begun = false;
    // Only samples taken after the command count: the drive's "in position" of the move before is stale.
    const HostTime commanded = HostClock::now();  // the last attempt, which move.started may lie well before
    for (HostTime last = commanded;;) {
      const AxisSample sample = sample_after(last, stop);
      last = sample.begun;
      ++move.polls;
      require_no_alarm(sample);
      require_enabled(sample);
      if (begun && sample.target) require_reference(sample);
      if (!sample.homed) {
        throw Error(ErrorCode::kStageNotHomed, "the drive at " + link_.description() +
                                                   " lost its reference in the move, as after a power cut; home again");
      }
      begun = begun || obeys(sample, move, before, criterion);
      if (sample.moving || !begun) {
        move.halted = {};
      } else if (move.halted == HostTime{}) {
        move.halted = sample.time;
      }
      if (!begun && sample.time - commanded > profile_.start_within) {
        throw Error(ErrorCode::kStagePosition, "the drive at " + link_.description() + " took the move to " +
                                                   std::to_string(move.target.value) +
                                                   " um without a word and does not move: is it ready and enabled?");
      }
      if (detector.add(sample.time, sample.position, !sample.moving && sample.in_position)) {
        move.position = sample.position;
        move.settled = HostClock::now();
        return;
      }
      if (sample.time - move.started > criterion.timeout) {
        this->stop();
        std::ostringstream message;
        message << "the axis did not settle within " << criterion.window.value << " um of "
                << move.target_quantised.value << " um in " << criterion.timeout.count() << " ms; it stands at "
                << sample.position.value << " um";
        throw Error(ErrorCode::kStagePosition, message.str());
      }
    }
  }

  const StageConfig config_;
  const DriveProfile profile_;
  ModbusLink link_;
  std::atomic<AxisState> state_{AxisState::kIdentifying};
  std::atomic<bool> expect_enabled_{false};
  std::atomic<HostTime> changed_{HostTime{}};  // by fvd: older samples do not tell what the drive is like now
  std::optional<std::int64_t> target_;         // steps, last one sent since homing
  std::unique_ptr<AxisPoller> poller_;
};

}  // namespace

ModbusLinkConfig modbus_link_config(const StageConfig& config) {
  ModbusLinkConfig link;
  if (config.transport == "rtu") {
    const char parity = config.serial_parity == "none" ? 'N' : config.serial_parity == "odd" ? 'O' : 'E';
    link.endpoint = ModbusSerialEndpoint{config.serial_device, config.serial_baud, parity, config.serial_stop_bits};
  } else {
    link.endpoint = ModbusTcpEndpoint{config.address, config.port};
  }
  link.unit = config.unit;
  link.response_timeout = config.response_timeout;
  link.quiet = config.quiet;
  return link;
}

std::unique_ptr<Axis> open_modbus_stage(const StageConfig& config) { return std::make_unique<ModbusAxis>(config); }

}  // namespace fvd
