#include "drivers/modbus/modbus_z_stage.hpp"

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <sstream>
#include <thread>
#include <variant>

#include <pthread.h>
#include <spdlog/spdlog.h>

#include "core/error.hpp"
#include "core/scan/settle_detector.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "drivers/modbus/modbus_link.hpp"
#include "drivers/modbus/position_log.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFastPoll{2};
constexpr milliseconds kIdlePoll{50};
/// Sampling stays fast for so long after the last thing that needed it.
constexpr milliseconds kFastFor{1000};
constexpr std::size_t kLoggedSamples = 8192;

class ModbusZStage final : public ZStage {
 public:
  explicit ModbusZStage(const StageConfig& config)
      : config_(config),
        profile_(load_drive_profile(config.profile)),
        link_({config.address, config.port, config.unit, config.response_timeout}),
        log_(kLoggedSamples) {
    poll_once();
    if (!connected_) throw Error(ErrorCode::kStageDisconnected, loss_);
    run_sequence(profile_.enable, {}, "enable");
    poller_ = std::jthread([this](std::stop_token stop) { poll(stop); });
    pthread_setname_np(poller_.native_handle(), "fvd-stage");
  }

  ~ModbusZStage() override {
    const ModbusLinkStats stats = link_.stats();
    spdlog::info(
        "stage link closed: {} transactions, {} retries, {} unknown, {} reconnects, latency p50 {:.0f} us p99 {:.0f} "
        "us",
        stats.transactions, stats.retries, stats.unknown, stats.reconnects, stats.latency_p50_us, stats.latency_p99_us);
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
    info.simulated = config_.simulated;
    return info;
  }

  [[nodiscard]] StageStatus status() override {
    const AxisSample sample = sample_after(HostClock::now(), {});
    StageStatus status;
    status.enabled = sample.enabled;
    status.homed = sample.homed;
    status.moving = sample.moving;
    status.in_position = sample.in_position;
    status.alarm = sample.alarm;
    status.alarm_code = sample.alarm_code;
    if (sample.alarm) status.alarm_text = alarm_text(sample.alarm_code);
    status.position = sample.position;
    return status;
  }

  void home(std::stop_token stop) override {
    require_no_alarm(sample_after(HostClock::now(), stop));
    const HostTime started = HostClock::now();
    run_sequence(profile_.home, {}, "home");
    bool moved = false;
    for (HostTime last = HostClock::now();;) {
      const AxisSample sample = halting_on_stop([&] { return sample_after(last, stop); });
      last = sample.time;
      require_no_alarm(sample);
      moved = moved || sample.moving || !sample.homed;
      // An axis that was homed and rests at its origin never shows motion: then the start time decides.
      const bool begun = moved || sample.time - started > profile_.start_within;
      if (begun && sample.homed && !sample.moving) return;
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
    MoveRecord move;
    move.target = target;
    move.target_counts = quantise(target);
    move.target_quantised = Micrometers{profile_.direction * move.target_counts.value / profile_.steps_per_um};
    require_within_limits(move.target_quantised);
    const AxisSample before = sample_after(HostClock::now(), stop);
    require_no_alarm(before);
    if (!before.homed) {
      throw Error(ErrorCode::kStageNotHomed, "no absolute move of " + link_.description() + " before it is homed");
    }
    move.started = HostClock::now();
    start_move(move, before, criterion, stop);
    halting_on_stop([&] { settle(move, before, criterion, stop); });
    return move;
  }

  [[nodiscard]] PositionMean mean_position(HostTime from, HostTime to) override {
    keep_fast();
    (void)sample_after(to, {});
    const std::lock_guard lock(mutex_);
    return log_.mean(from, to);
  }

  void stop() noexcept override {
    try {
      for (const DriveFrame& frame : profile_.stop) {
        const auto words = encoded(frame, {});
        const ModbusReply reply = link_.write(frame.address(), words, ModbusPriority::kUrgent);
        if (reply.outcome != ModbusOutcome::kOk) spdlog::error("stage stop was not confirmed: {}", reply.error);
      }
    } catch (const std::exception& error) {
      spdlog::error("stage stop failed: {}", error.what());
    }
  }

  [[nodiscard]] bool connected() const noexcept override { return connected_; }

 private:
  // --- sampling ---

  void poll(std::stop_token stop) {
    while (!stop.stop_requested() && connected_) {
      poll_once();
      std::unique_lock lock(mutex_);
      const HostTime now = HostClock::now();
      const HostTime next = now + (now < fast_until_ ? kFastPoll : kIdlePoll);
      const HostTime fast_until = fast_until_;
      wake_.wait_until(lock, stop, next, [&] { return fast_until_ != fast_until && next - now > kFastPoll; });
    }
  }

  void poll_once() {
    ModbusReply reply = link_.read(profile_.poll_address, profile_.poll_count);
    {
      const std::lock_guard lock(mutex_);
      if (reply.outcome == ModbusOutcome::kOk) {
        const RegisterBlock block(profile_.poll_address, std::move(reply.values));
        AxisSample sample;
        sample.time = reply.sampled;
        sample.position = Micrometers{profile_.direction * static_cast<double>(block.value(profile_.position)) /
                                      profile_.counts_per_um};
        sample.enabled = profile_.enabled.holds(block);
        sample.homed = profile_.homed.holds(block);
        sample.moving = profile_.moving.holds(block);
        sample.in_position = profile_.in_position.holds(block);
        sample.alarm = profile_.alarm.holds(block);
        sample.alarm_code = static_cast<int>(block.value(profile_.alarm_code));
        log_.add(sample);
      } else {
        loss_ = "the drive at " + link_.description() + " does not answer: " + reply.error;
        connected_ = false;
      }
    }
    sampled_.notify_all();
  }

  void keep_fast() {
    {
      const std::lock_guard lock(mutex_);
      fast_until_ = HostClock::now() + kFastFor;
    }
    wake_.notify_all();
  }

  /// The first sample taken after `after`. Throws when the drive is lost or stop is requested.
  AxisSample sample_after(HostTime after, std::stop_token stop) {
    keep_fast();
    std::unique_lock lock(mutex_);
    const auto there = [&] {
      const auto latest = log_.latest();
      return !connected_ || (latest && latest->time > after);
    };
    if (!sampled_.wait(lock, stop, there)) throw Error(ErrorCode::kAborted, "the axis was asked to stop");
    if (!connected_) throw Error(ErrorCode::kStageDisconnected, loss_);
    return *log_.latest();
  }

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

  struct Values {
    std::int64_t target = 0;
    std::int64_t speed = 0;
    std::int64_t acceleration = 0;
  };

  [[nodiscard]] static std::vector<std::uint16_t> encoded(const DriveFrame& frame, const Values& values) {
    std::vector<std::uint16_t> words;
    for (const RegisterWrite& write : frame.writes) {
      std::int64_t value = 0;
      if (const auto* number = std::get_if<std::int64_t>(&write.value)) {
        value = *number;
      } else {
        switch (std::get<DriveVariable>(write.value)) {
          case DriveVariable::kTarget:
            value = values.target;
            break;
          case DriveVariable::kSpeed:
            value = values.speed;
            break;
          case DriveVariable::kAcceleration:
            value = values.acceleration;
            break;
        }
      }
      const auto encoded_value = encode(write.reg, value);
      words.insert(words.end(), encoded_value.begin(), encoded_value.end());
    }
    return words;
  }

  /// Writes a sequence whose repetition would do no harm; anything but "ok" is an error.
  void run_sequence(const DriveSequence& sequence, const Values& values, const char* name) {
    for (const DriveFrame& frame : sequence) {
      const ModbusReply reply = link_.write(frame.address(), encoded(frame, values));
      if (reply.outcome == ModbusOutcome::kOk) continue;
      const auto code =
          reply.outcome == ModbusOutcome::kRejected ? ErrorCode::kStagePosition : ErrorCode::kStageDisconnected;
      throw Error(code,
                  std::string("the drive at ") + link_.description() + " did not take '" + name + "': " + reply.error);
    }
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

  [[nodiscard]] std::string alarm_text(int code) const {
    std::ostringstream text;
    text << "alarm 0x" << std::hex << std::uppercase << code;
    const auto known = profile_.alarms.find(code);
    text << ": " << (known == profile_.alarms.end() ? "see the drive's manual" : known->second);
    return text.str();
  }

  void require_no_alarm(const AxisSample& sample) const {
    if (!sample.alarm) return;
    throw Error(ErrorCode::kStageAlarm, "the drive at " + link_.description() + " reports " +
                                            alarm_text(sample.alarm_code) + "; clear the cause, then reset the alarm");
  }

  /// Sends the move. Without a usable answer it looks whether the axis obeys, and only if it does not, sends the same
  /// absolute target once more: an absolute move that did arrive is not repeated by that.
  void start_move(const MoveRecord& move, const AxisSample& before, const SettleCriterion& criterion,
                  std::stop_token stop) {
    const Values values{move.target_counts.value,
                        std::max<std::int64_t>(1, std::llround(config_.speed_um_per_s * profile_.speed_units_per_um_s)),
                        std::max<std::int64_t>(
                            1, std::llround(config_.acceleration_um_per_s2 * profile_.acceleration_units_per_um_s2))};
    for (int attempt = 1;; ++attempt) {
      bool unknown = false;
      for (const DriveFrame& frame : profile_.move_absolute) {
        const ModbusReply reply = link_.write(frame.address(), encoded(frame, values));
        if (reply.outcome == ModbusOutcome::kRejected) {
          throw Error(ErrorCode::kStagePosition,
                      "the drive at " + link_.description() + " refused the move: " + reply.error);
        }
        if (reply.outcome == ModbusOutcome::kUnknown) {
          spdlog::warn("no answer to a move to {} um: {}", move.target.value, reply.error);
          unknown = true;
          break;
        }
      }
      if (!unknown || has_begun(move, before, criterion, stop)) return;
      if (attempt == 2) {
        throw Error(ErrorCode::kStageDisconnected, "the drive at " + link_.description() + " answers no move command");
      }
    }
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
      last = sample.time;
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
      last = sample.time;
      ++move.polls;
      require_no_alarm(sample);
      begun = begun || obeys(sample, move, before, criterion);
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
  mutable std::mutex mutex_;
  std::condition_variable_any sampled_;
  std::condition_variable_any wake_;
  PositionLog log_;  // guarded by mutex_, as is all up to loss_
  HostTime fast_until_{};
  std::string loss_;
  std::atomic<bool> connected_{true};
  std::jthread poller_;  // last
};

}  // namespace

std::unique_ptr<ZStage> open_modbus_stage(const StageConfig& config) { return std::make_unique<ModbusZStage>(config); }

}  // namespace fvd
