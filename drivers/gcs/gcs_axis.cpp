#include "drivers/gcs/gcs_axis.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "core/base/error.hpp"
#include "drivers/common/axis_controller.hpp"
#include "drivers/common/drive_lock.hpp"
#include "drivers/common/text_line.hpp"

namespace fvd {

namespace {

/// Targets are sent in mm with six decimals: a step is a nanometre.
constexpr double kStepsPerUm = 1000.0;
constexpr double kUmPerMm = 1000.0;

constexpr int kQuestionAttempts = 3;
constexpr int kNoError = 0;
constexpr int kUnknownCommand = 2;
constexpr int kStopped = 10;  ///< what every stop leaves behind
const char* const kAskMotion = "\x05";

/// Error codes that mean that the axis is not to be used; all others tell of a single command.
const std::map<int, const char*>& alarms() {
  static const std::map<int, const char*> kAlarms{{-1024, "motion error: position error too large, servo switched off"},
                                                  {500, "emergency stop is pressed"},
                                                  {501, "emergency stop was pressed"},
                                                  {502, "redundancy limit exceeded"},
                                                  {503, "collision switch activated"},
                                                  {504, "following error"}};
  return kAlarms;
}

std::string millimetres(double um) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6f", um / kUmPerMm);
  return text.data();
}

/// The value of "axis=value"; nothing if it is another axis' or no number.
std::optional<double> value_of(const std::string& answer, const std::string& axis) {
  if (answer.rfind(axis + "=", 0) != 0) return std::nullopt;
  const char* const begin = answer.data() + axis.size() + 1;
  const char* const end = answer.data() + answer.size();
  double value = 0.0;
  const auto [stop, failure] = std::from_chars(begin + (begin < end && *begin == '+' ? 1 : 0), end, value);
  if (failure != std::errc{} || !std::isfinite(value) ||
      std::any_of(stop, end, [](char c) { return c != ' ' && c != '\r'; })) {
    return std::nullopt;
  }
  return value;
}

template <typename Integer>
std::optional<Integer> integer_of(const std::string& answer, int base) {
  const std::size_t prefix = base == 16 && answer.rfind("0x", 0) == 0 ? 2 : 0;
  Integer value = 0;
  const char* const end = answer.data() + answer.size();
  const auto [stop, failure] = std::from_chars(answer.data() + prefix, end, value, base);
  if (failure != std::errc{} || (stop != end && *stop != '\r' && *stop != ' ')) return std::nullopt;
  return value;
}

class GcsPort final : public AxisPort {
 public:
  explicit GcsPort(const StageConfig& config)
      : lock_(drive_lock_of(config)),
        axis_(config.gcs_axis),
        sign_(config.reversed ? -1.0 : 1.0),
        line_(line_config(config)) {
    traits_.name = identity();
    traits_.address = line_.description() + " axis " + axis_;
    traits_.feedback =
        config.gcs_feedback == "linear_scale" ? FeedbackSource::kLinearScale : FeedbackSource::kMotorEncoder;
    traits_.steps_per_um = sign_ * kStepsPerUm;
    traits_.feedback_resolution = Micrometers{1.0 / kStepsPerUm};
    traits_.sample_timeout = std::chrono::seconds(5) + 10 * config.response_timeout;
    find_axis();
    const Micrometers one = travel_limit("TMN?");
    const Micrometers other = travel_limit("TMX?");
    traits_.limits = std::pair(std::min(one, other), std::max(one, other));
  }

  [[nodiscard]] const AxisTraits& traits() const override { return traits_; }

  [[nodiscard]] std::optional<AxisSample> sample(std::string& error) override {
    AxisSample sample;
    sample.begun = HostClock::now();
    // The state first: it is then not newer than the position.
    const auto state = questions(kAskMotion + ask("SVO?") + ask("FRF?") + ask("ONT?") + "ERR?\n", 5, error);
    if (!state) return std::nullopt;
    const auto where = questions(ask("POS?"), 1, error, &sample.time);
    if (!where) return std::nullopt;
    const auto moving = integer_of<unsigned long>((*state)[0], 16);
    const auto servo = value_of((*state)[1], axis_);
    const auto referenced = value_of((*state)[2], axis_);
    const auto on_target = value_of((*state)[3], axis_);
    const auto code = integer_of<int>((*state)[4], 10);
    const auto position_mm = value_of((*where)[0], axis_);
    if (!moving || !servo || !referenced || !on_target || !code || !position_mm) {
      error = "an answer that makes no sense";
      return std::nullopt;
    }
    sample.moving = (*moving >> axis_index_ & 1U) != 0;
    sample.enabled = *servo != 0.0;
    sample.homed = *referenced != 0.0;
    sample.in_position = *on_target != 0.0;
    sample.position = Micrometers{sign_ * *position_mm * kUmPerMm};
    if (*code == kNoError && sample.enabled) alarm_ = kNoError;  // whoever switched the servo on has seen to it
    note_alarm(*code);
    sample.alarm_code = alarm_;
    sample.alarm = sample.alarm_code != kNoError;
    return sample;
  }

  /// Controllers that cannot set an acceleration have one of their own.
  [[nodiscard]] CommandResult prepare(const MotionLimits& limits, std::stop_token /*stop*/) override {
    speed_um_per_s_ = 0.0;
    for (const char* const command : {"ACC", "DEC"}) {
      CommandResult set = run(command, millimetres(limits.acceleration_um_per_s2), {kUnknownCommand});
      if (set.outcome != CommandOutcome::kDone) return set;
    }
    return {};
  }

  [[nodiscard]] CommandResult enable(const MotionLimits& /*limits*/, std::stop_token /*stop*/) override {
    return run("SVO", "1");
  }

  /// An alarm switches the servo off; who switches it on has seen to the cause.
  [[nodiscard]] CommandResult reset_alarm(std::stop_token /*stop*/) override { return run("SVO", "1"); }

  [[nodiscard]] CommandResult home(const MotionLimits& limits, std::stop_token /*stop*/) override {
    const CommandResult set = set_speed(limits.speed_um_per_s);
    return set.outcome == CommandOutcome::kDone ? run("FRF", "") : set;
  }

  [[nodiscard]] CommandResult move(StageCounts target, const MotionLimits& limits, std::stop_token /*stop*/) override {
    const CommandResult set = set_speed(limits.speed_um_per_s);
    return set.outcome == CommandOutcome::kDone ? run("MOV", millimetres(target.value / kStepsPerUm)) : set;
  }

  [[nodiscard]] CommandResult stop() override {
    std::string error;
    const auto answers = line_.exchange("HLT " + axis_ + "\nERR?\n", 1, error, true);
    return result("HLT", answers, error, {kStopped});
  }

  [[nodiscard]] std::string alarm_text(int code) const override {
    const auto known = alarms().find(code);
    return "error " + std::to_string(code) + (known == alarms().end() ? "" : std::string(": ") + known->second);
  }

  [[nodiscard]] std::optional<StageLinkStats> link_stats() const override {
    const TextLine::Statistics line = line_.statistics();
    StageLinkStats stats;
    stats.requests = line.exchanges;
    stats.unanswered = line.unanswered;
    stats.reconnects = line.reopenings;
    stats.refused = refused_;
    return stats;
  }

 private:
  static TextLineConfig line_config(const StageConfig& config) {
    TextLineConfig line{config.address, config.port, {}, config.serial_baud, config.response_timeout, ' '};
    if (config.transport != "tcp") line.serial_device = config.serial_device;
    return line;
  }

  [[nodiscard]] std::string ask(const char* question) const { return std::string(question) + ' ' + axis_ + '\n'; }

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorCode::kStageDisconnected, "the controller at " + line_.description() + " " + what);
  }

  /// Questions do no harm twice. middle: of the exchange that was answered.
  std::optional<std::vector<std::string>> questions(const std::string& text, int count, std::string& error,
                                                    HostTime* middle = nullptr) {
    std::optional<std::vector<std::string>> answers;
    for (int attempt = 0; attempt < kQuestionAttempts && !answers; ++attempt) {
      const HostTime asked = HostClock::now();
      answers = line_.exchange(text, count, error);
      if (middle != nullptr) *middle = asked + (HostClock::now() - asked) / 2;
    }
    return answers;
  }

  std::string answer_to(const std::string& question) {
    std::string error;
    auto answers = questions(question, 1, error);
    if (!answers) refuse("does not answer: " + error);
    return answers->front();
  }

  std::string identity() {
    std::string name = answer_to("*IDN?\n");
    while (!name.empty() && (name.back() == ' ' || name.back() == '\r')) name.pop_back();
    return name.substr(0, 64);
  }

  /// The motion status has one bit per axis, in the order in which the controller lists them.
  void find_axis() {
    std::istringstream names(answer_to("SAI?\n"));
    std::string all;
    for (std::string name; names >> name; ++axis_index_) {
      if (name == axis_) return;
      all += ' ' + name;
    }
    refuse("has no axis '" + axis_ + "', only" + all.substr(0, 64) + ": see /stage/gcs_axis");
  }

  Micrometers travel_limit(const char* question) {
    const auto limit = value_of(answer_to(ask(question)), axis_);
    if (!limit) refuse(std::string("gives no travel limit ") + question);
    return Micrometers{sign_ * *limit * kUmPerMm};
  }

  CommandResult set_speed(double um_per_s) {
    if (um_per_s == speed_um_per_s_) return {};
    CommandResult set = run("VEL", millimetres(um_per_s));
    speed_um_per_s_ = set.outcome == CommandOutcome::kDone ? um_per_s : 0.0;
    return set;
  }

  /// What an earlier command left as error is read first, and so forgotten. accepted: codes beside 0 that are no
  /// refusal.
  CommandResult run(const std::string& command, const std::string& value, std::initializer_list<int> accepted = {}) {
    std::string error;
    const std::string text = command + ' ' + axis_ + (value.empty() ? "" : ' ' + value);
    const auto answers = line_.exchange("ERR?\n" + text + "\nERR?\n", 2, error);
    if (answers) note_alarm(integer_of<int>(answers->front(), 10).value_or(kNoError));
    return result(command, answers, error, accepted);
  }

  /// A code is told once: whoever reads it keeps it for the samples.
  void note_alarm(int code) {
    if (alarms().count(code) != 0) alarm_ = code;
  }

  CommandResult result(const std::string& command, const std::optional<std::vector<std::string>>& answers,
                       const std::string& error, std::initializer_list<int> accepted) {
    if (!answers) return {CommandOutcome::kUnknown, command + ": " + error};
    const auto code = integer_of<int>(answers->back(), 10);
    if (!code) return {CommandOutcome::kUnknown, command + ": an answer that makes no sense"};
    note_alarm(*code);
    if (*code == kNoError || std::find(accepted.begin(), accepted.end(), *code) != accepted.end()) return {};
    ++refused_;
    return {CommandOutcome::kRefused, command + ": error " + std::to_string(*code)};
  }

  const std::shared_ptr<const DriveLock> lock_;  // first: nothing is sent without it
  const std::string axis_;
  const double sign_;  // of the controller's position as z grows
  TextLine line_;
  AxisTraits traits_;
  unsigned axis_index_ = 0;
  double speed_um_per_s_ = 0.0;  // as set; 0 = unknown. The mover's thread only
  std::atomic<int> alarm_{kNoError};
  std::atomic<std::uint64_t> refused_{0};
};

}  // namespace

std::unique_ptr<Axis> open_gcs_stage(const StageConfig& config) {
  return make_axis(std::make_unique<GcsPort>(config), axis_settings(config));
}

}  // namespace fvd
