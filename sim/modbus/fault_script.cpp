#include "sim/modbus/fault_script.hpp"

#include <array>

#include "core/base/error.hpp"
#include "sim/modbus/modbus_responder.hpp"

namespace fvd::sim {

namespace {

/// The most registers that one request may write.
constexpr std::size_t kMaxWrite = 123;

constexpr std::array<std::string_view, 3> kOnNames{"read", "write", "any"};

void check(const FaultStep& step) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::kBadConfig, "fault step " + std::string(name_of(step.fault)) + ": " + what);
  };
  if (step.after < 0) refuse("after " + std::to_string(step.after) + " is negative");
  if (step.count < 1) refuse("count " + std::to_string(step.count) + " is not above 0");
  if (step.delay.count() < 0) refuse("delay_ms " + std::to_string(step.delay.count()) + " is negative");
  const bool needs_delay = step.fault == FaultKind::kLateReply || step.fault == FaultKind::kStaleInPosition;
  if (needs_delay && step.delay.count() == 0) refuse("needs delay_ms above 0");
  const bool is_exception = step.fault == FaultKind::kException || step.fault == FaultKind::kExceptionAfter;
  if (is_exception && (step.code < 1 || step.code > 255)) refuse("needs code 1..255");
  if (step.fault == FaultKind::kAlarmInMotion && (step.code < 1 || step.code > 65535)) refuse("needs code 1..65535");
  if (step.fault == FaultKind::kSecondMaster) {
    if (step.words.empty() || step.words.size() > kMaxWrite) refuse("needs 1 to 123 words");
    if (step.to < 0 || step.to + static_cast<int>(step.words.size()) > 0x10000) refuse("writes beyond register 65535");
  }
}

bool matches(const FaultStep& step, std::span<const std::uint8_t> request, bool axis_moves) {
  const RequestSummary summary = summary_of(request);
  if (step.on == FaultOn::kRead && summary.writes) return false;
  if (step.on == FaultOn::kWrite && !summary.writes) return false;
  if (step.address && !summary.contains(*step.address)) return false;
  return step.fault != FaultKind::kAlarmInMotion || axis_moves;
}

}  // namespace

const std::vector<std::string>& fault_names() {
  static const std::vector<std::string> kNames{
      "late_reply",     "lost_reply",      "lost_request",      "wrong_crc",       "truncated_frame", "exception",
      "silent_refusal", "link_cut",        "stale_in_position", "alarm_in_motion", "limit_hit",       "emergency_stop",
      "power_cycle",    "exception_after", "swapped_words",     "second_master"};
  return kNames;
}

std::string_view name_of(FaultKind kind) { return fault_names()[static_cast<std::size_t>(kind)]; }

FaultScript::FaultScript(const std::vector<FaultStep>& steps) {
  for (const FaultStep& step : steps) add(step);
}

void FaultScript::add(const FaultStep& step) {
  check(step);
  const MutexLock lock(mutex_);
  steps_.push_back(step);
}

std::optional<FaultStep> FaultScript::next(std::span<const std::uint8_t> request, bool axis_moves) {
  const MutexLock lock(mutex_);
  if (steps_.empty() || !matches(steps_.front(), request, axis_moves)) return std::nullopt;
  FaultStep& step = steps_.front();
  if (step.after > 0) {
    --step.after;
    return std::nullopt;
  }
  const FaultStep fault = step;
  if (--step.count == 0) {
    steps_.pop_front();
    ++taken_;
  }
  return fault;
}

void FaultScript::failed(const FaultStep& step, const std::string& reason) {
  const MutexLock lock(mutex_);
  failed_.push_back(std::string(name_of(step.fault)) + ": " + reason);
}

std::size_t FaultScript::unconsumed() const {
  const MutexLock lock(mutex_);
  return steps_.size() + failed_.size();
}

std::string FaultScript::describe_unconsumed() const {
  const MutexLock lock(mutex_);
  std::string text;
  for (const std::string& failed : failed_) text += (text.empty() ? "" : "\n") + failed;
  int number = taken_;
  for (const FaultStep& step : steps_) {
    if (!text.empty()) text += '\n';
    text += "step " + std::to_string(++number) + ": " + std::string(name_of(step.fault)) + " on " +
            std::string(kOnNames[static_cast<std::size_t>(step.on)]);
    if (step.address) text += " of address " + std::to_string(*step.address);
    if (step.after > 0) text += ", after " + std::to_string(step.after) + " more";
    text += ", " + std::to_string(step.count) + (step.count == 1 ? " time" : " times") + " to go";
  }
  return text;
}

}  // namespace fvd::sim
