#include "drivers/modbus/modbus_axis.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "drivers/common/axis_controller.hpp"
#include "drivers/common/drive_lock.hpp"
#include "drivers/modbus/drive_check.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "drivers/modbus/modbus_link.hpp"
#include "drivers/modbus/own_writes.hpp"

namespace fvd {

namespace {

CommandResult command_result(const SequenceResult& result) {
  switch (result.outcome) {
    case ModbusOutcome::kOk:
      return {};
    case ModbusOutcome::kRejected:
      return {CommandOutcome::kRefused, result.error};
    case ModbusOutcome::kUnknown:
      break;
  }
  return {CommandOutcome::kUnknown, result.error, result.later, result.repeatable};
}

/// The profile, counting the way that this machine's stage is built.
DriveProfile profile_for(const StageConfig& config) {
  DriveProfile profile = load_drive_profile(config.profile);
  if (config.reversed) profile.direction = -profile.direction;
  return profile;
}

/// A drive that its profile describes. The calls of one motion come from one thread.
class ModbusPort final : public AxisPort {
 public:
  explicit ModbusPort(const StageConfig& config)
      : profile_(profile_for(config)),
        own_writes_(profile_.watched),
        lock_(drive_lock_of(config)),
        link_(modbus_link_config(config)) {
    link_.observe_writes(
        [this](const ModbusRequest& write, bool sent, bool done) { own_writes_.saw(write, sent, done); });
    identify();
    describe(config);
    spdlog::info("stage: {} at {}", traits_.name, traits_.address);
  }

  ~ModbusPort() override {
    // A drive that still moves keeps its watchdog: nobody else stops it from here on.
    if (watchdog_armed_ && answers_ && rests_) (void)write_watchdog(profile_.watchdog->disarmed);
    const ModbusLinkStats stats = link_.stats();
    spdlog::info(
        "stage link closed: {} transactions, {} retries, {} unknown, {} put off, {} reconnects, {} bytes discarded, "
        "latency p50 {:.0f} us p99 {:.0f} us",
        stats.transactions, stats.retries, stats.unknown, stats.later, stats.reconnects, stats.discarded_bytes,
        stats.latency_p50_us, stats.latency_p99_us);
  }

  [[nodiscard]] const AxisTraits& traits() const override { return traits_; }

  [[nodiscard]] std::optional<AxisSample> sample(std::string& error) override {
    RegisterImage image;
    AxisSample sample;
    sample.begun = HostClock::now();
    for (const PollBlock& block : profile_.poll) {
      ModbusReply reply = link_.read(block.table, block.address, block.count);
      answers_ = reply.outcome == ModbusOutcome::kOk;
      if (!answers_) {
        error = reply.error + (answered_once_ ? "" : ". " + link_.advice());
        return std::nullopt;
      }
      answered_once_ = true;
      sample.time = reply.sampled;  // the last block's, which holds the position
      image.add(block, std::move(reply.values));
    }
    const auto lookup = [&](const DriveRegister& reg) { return image.value(reg); };
    const auto holds = [&](const DriveCondition& condition) { return condition.holds(lookup).value_or(false); };
    const auto holds_if = [&](const std::optional<DriveCondition>& condition) {
      return condition && holds(*condition);
    };
    sample.position = Micrometers{profile_.direction * static_cast<double>(image.value(profile_.position).value_or(0)) /
                                  profile_.counts_per_um};
    sample.enabled = holds(profile_.enabled);
    sample.homed = holds_if(profile_.homed);
    sample.moving = holds(profile_.moving);
    rests_ = sample.reports_rest();
    sample.in_position = holds(profile_.in_position);
    sample.alarm = holds(profile_.alarm);
    if (profile_.target) sample.target = image.value(*profile_.target);
    if (sample.alarm) add_alarm(sample, image.value(profile_.alarm_code));
    sample.limit_positive = holds_if(profile_.limit_positive);
    sample.limit_negative = holds_if(profile_.limit_negative);
    sample.emergency_stop = holds_if(profile_.emergency_stop);
    return sample;
  }

  [[nodiscard]] std::vector<std::string> disagreements(std::stop_token stop) override {
    return check_drive(profile_, link_, std::move(stop)).disagreements;
  }

  [[nodiscard]] CommandResult prepare(const MotionLimits& limits, std::stop_token stop) override {
    CommandResult result = run(profile_.prepare, values({}, limits), std::move(stop));
    if (result.outcome == CommandOutcome::kDone) arm_watchdog();
    return result;
  }

  [[nodiscard]] CommandResult enable(const MotionLimits& limits, std::stop_token stop) override {
    return run(profile_.enable, values({}, limits), std::move(stop));
  }

  [[nodiscard]] CommandResult reset_alarm(std::stop_token stop) override {
    return run(profile_.alarm_reset, {}, std::move(stop));
  }

  [[nodiscard]] CommandResult home(const MotionLimits& limits, std::stop_token stop) override {
    return begin(profile_.home, values({}, limits), std::move(stop));
  }

  [[nodiscard]] CommandResult move(StageCounts target, const MotionLimits& limits, std::stop_token stop) override {
    return begin(profile_.move_absolute, values(target, limits), std::move(stop));
  }

  /// Edges that were set are taken back.
  [[nodiscard]] CommandResult resume(std::stop_token stop) override {
    const SequenceResult result =
        run_sequence(link_, *motion_, values_, ModbusPriority::kNormal, std::move(stop), resume_at_);
    resume_at_ = result.step + (result.repeatable ? 0 : 1);
    return command_result(result);
  }

  [[nodiscard]] CommandResult stop() override {
    return command_result(run_sequence(link_, profile_.stop, {}, ModbusPriority::kUrgent, {}));
  }

  [[nodiscard]] std::optional<ForeignWrite> foreign_write(std::stop_token stop) override {
    auto found = own_writes_.foreign(link_, stop);
    if (!found || !found->is_restart || !profile_.homed) return found;
    const auto lookup = [&](const DriveRegister& reg) {
      return read_register(link_, reg, ModbusPriority::kNormal, stop);
    };
    found->is_restart = !profile_.homed->holds(lookup).value_or(false);  // a drive that says so forgets it, too
    return found;
  }

  [[nodiscard]] std::optional<std::int64_t> remembered_target(std::stop_token stop) override {
    if (!profile_.target) return std::nullopt;
    return read_register(link_, *profile_.target, ModbusPriority::kNormal, std::move(stop));
  }

  [[nodiscard]] std::string alarm_text(int code) const override { return fvd::alarm_text(profile_, code); }

  [[nodiscard]] std::vector<StageTemperature> temperatures() override {
    std::vector<StageTemperature> read;
    for (const DriveTemperature& temperature : profile_.temperatures) {
      const auto value = read_register(link_, temperature.reg);
      if (value) read.push_back({temperature.name, static_cast<double>(*value) * temperature.celsius_per_unit});
    }
    return read;
  }

  [[nodiscard]] std::optional<StageLinkStats> link_stats() const override {
    const ModbusLinkStats stats = link_.stats();
    return StageLinkStats{.requests = stats.transactions,
                          .retries = stats.retries,
                          .unanswered = stats.unknown,
                          .refused = stats.rejected,
                          .reconnects = stats.reconnects,
                          .discarded_bytes = stats.discarded_bytes,
                          .implausible = 0,
                          .put_off = stats.later,
                          .latency_p50_us = stats.latency_p50_us,
                          .latency_p99_us = stats.latency_p99_us,
                          .latency_max_us = stats.latency_max_us};
  }

 private:
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

  void describe(const StageConfig& config) {
    traits_.name = profile_.name + labels();
    traits_.address = link_.description();
    traits_.doubt_hint = ", and whether /word_order of the profile is the drive's: the words may be exchanged";
    traits_.feedback = profile_.feedback;
    traits_.steps_per_um = profile_.direction * profile_.steps_per_um;
    traits_.feedback_resolution = Micrometers{std::max(profile_.feedback_resolution_um, 1.0 / profile_.counts_per_um)};
    traits_.lead = Micrometers{profile_.lead_um};
    traits_.limits = soft_limits();
    traits_.tells_homed = profile_.homed.has_value();
    traits_.start_within = profile_.start_within;
    traits_.home_timeout = profile_.home_timeout;
    // Five readings of every block, each tried three times, behind one start of a move with its handshakes; a drive
    // that is busy may put off each block once for as long as it may.
    traits_.sample_timeout = std::chrono::seconds(5) +
                             static_cast<int>(profile_.poll.size()) * ModbusLinkConfig{}.patience +
                             15 * static_cast<int>(profile_.poll.size() + 1) * (config.response_timeout + config.quiet);
  }

  /// " (firmware 12, serial 3456)"; empty where the profile has none.
  [[nodiscard]] std::string labels() {
    std::string all;
    for (const DriveLabel& label : profile_.labels) {
      const auto value = read_register(link_, label.reg);
      all += (all.empty() ? " (" : ", ") + label.name + " " + (value ? std::to_string(*value) : "unknown");
    }
    return all.empty() ? all : all + ")";
  }

  [[nodiscard]] std::optional<std::pair<Micrometers, Micrometers>> soft_limits() {
    if (!profile_.soft_limits) return std::nullopt;
    std::string why;
    const auto positive = read_register(link_, profile_.soft_limits->positive, ModbusPriority::kNormal, {}, &why);
    const auto negative = read_register(link_, profile_.soft_limits->negative, ModbusPriority::kNormal, {}, &why);
    if (!positive || !negative) {
      throw Error(ErrorCode::kStageDisconnected,
                  "the drive at " + link_.description() + " does not tell its limits of travel: " + why);
    }
    if (*negative >= *positive) {
      spdlog::info("the drive at {} has no limits of travel set: {} to {} steps", link_.description(), *negative,
                   *positive);
      return std::nullopt;
    }
    const Micrometers one{static_cast<double>(*positive) / traits_.steps_per_um};
    const Micrometers other{static_cast<double>(*negative) / traits_.steps_per_um};
    return std::pair(std::min(one, other), std::max(one, other));
  }

  void add_alarm(AxisSample& sample, std::optional<std::int64_t> code) {
    if (!code) code = read_register(link_, profile_.alarm_code);
    sample.alarm_code = static_cast<int>(code.value_or(0));
    const std::vector<DriveAlarm> alarms = alarms_of(profile_, sample.alarm_code);
    sample.reference_lost =
        std::any_of(alarms.begin(), alarms.end(), [](const DriveAlarm& alarm) { return alarm.position_lost; });
  }

  /// Not before the settings: a drive that is being halted or identified is not to be stopped by silence in between.
  void arm_watchdog() {
    if (!profile_.watchdog) return;
    const ModbusReply reply = write_watchdog(profile_.watchdog->armed);
    watchdog_armed_ = reply.outcome != ModbusOutcome::kRejected;
    if (reply.outcome != ModbusOutcome::kOk) spdlog::warn("the drive's watchdog could not be armed: {}", reply.error);
  }

  ModbusReply write_watchdog(std::int64_t value) {
    const DriveRegister& reg = profile_.watchdog->reg;
    return link_.write(reg.table, reg.address, encode(reg, value), ModbusPriority::kNormal,
                       {.single = reg.write_single, .repeatable = true});
  }

  [[nodiscard]] DriveValues values(StageCounts target, const MotionLimits& limits) const {
    return {target.value, profile_.speed.value(limits.speed_um_per_s),
            profile_.acceleration.value(limits.acceleration_um_per_s2)};
  }

  CommandResult begin(const DriveSequence& sequence, const DriveValues& values, std::stop_token stop) {
    motion_ = &sequence;
    values_ = values;
    resume_at_ = 0;
    return resume(std::move(stop));
  }

  CommandResult run(const DriveSequence& sequence, const DriveValues& values, std::stop_token stop) {
    return command_result(run_sequence(link_, sequence, values, ModbusPriority::kNormal, std::move(stop)));
  }

  const DriveProfile profile_;
  OwnWrites own_writes_;                         // before the link, which tells it of every write
  const std::shared_ptr<const DriveLock> lock_;  // before the link: nothing is sent without it
  ModbusLink link_;
  AxisTraits traits_;
  std::atomic<bool> answers_{true};
  std::atomic<bool> answered_once_{false};
  std::atomic<bool> rests_{false};         // as of the last sample
  bool watchdog_armed_ = false;            // the mover's thread only, as the three below
  const DriveSequence* motion_ = nullptr;  // the move or the homing that was begun last
  DriveValues values_;                     // of it
  std::size_t resume_at_ = 0;              // of its steps
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

std::unique_ptr<Axis> open_modbus_stage(const StageConfig& config) {
  return make_axis(std::make_unique<ModbusPort>(config), axis_settings(config));
}

}  // namespace fvd
