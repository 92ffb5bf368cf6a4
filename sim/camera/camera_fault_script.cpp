#include "sim/camera/camera_fault_script.hpp"

#include "core/base/error.hpp"

namespace fvd::sim {

namespace {

CameraEvent event_of(const CameraFaultStep& step) { return step.on.value_or(event_of(step.fault)); }

bool needs_delay(CameraFault fault) {
  return fault == CameraFault::kMute || fault == CameraFault::kHang || fault == CameraFault::kRestart ||
         fault == CameraFault::kLateFrame || fault == CameraFault::kPendingAck;
}

void check(const CameraFaultStep& step) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::kBadConfig, "camera fault step " + std::string(name_of(step.fault)) + ": " + what);
  };
  if (step.after < 0) refuse("after " + std::to_string(step.after) + " is negative");
  if (step.count < 1) refuse("count " + std::to_string(step.count) + " is not above 0");
  if (step.delay.count() < 0) refuse("delay_ms " + std::to_string(step.delay.count()) + " is negative");
  if (needs_delay(step.fault) && step.delay.count() == 0) refuse("needs delay_ms above 0");
  const bool needs_step = step.fault == CameraFault::kClockStep || step.fault == CameraFault::kOddTime;
  if (needs_step && step.step.count() == 0) refuse("needs step_ms other than 0");
  const bool needs_value = step.fault == CameraFault::kIdJump || step.fault == CameraFault::kPaddedLines;
  if (needs_value && step.value < 1) refuse("needs value above 0");
  if (step.on && !strikes_anywhere(step.fault) && *step.on != event_of(step.fault)) refuse("cannot strike there");
}

}  // namespace

const std::vector<std::string>& camera_fault_names() {
  static const std::vector<std::string> kNames{"drop_leader",     "drop_trailer",   "drop_packet",  "drop_frame",
                                               "drop_ack",        "ignore_trigger", "nack_trigger", "duplicate_frame",
                                               "reorder_packets", "late_frame",     "wrong_size",   "too_long",
                                               "early_leader",    "id_jump",        "ids_restart",  "stale_frame",
                                               "dark_frame",      "half_frame",     "mute",         "hang",
                                               "restart",         "pending_ack",    "busy",         "clock_step",
                                               "odd_time",        "chunk_mode",     "other_format", "padded_lines",
                                               "forget_stream"};
  return kNames;
}

std::string_view name_of(CameraFault fault) { return camera_fault_names()[static_cast<std::size_t>(fault)]; }

bool strikes_anywhere(CameraFault fault) {
  return fault == CameraFault::kMute || fault == CameraFault::kHang || fault == CameraFault::kRestart ||
         fault == CameraFault::kClockStep || fault == CameraFault::kChunkMode;
}

CameraEvent event_of(CameraFault fault) {
  switch (fault) {
    case CameraFault::kDropAck:
    case CameraFault::kPendingAck:
    case CameraFault::kBusy:
      return CameraEvent::kCommand;
    case CameraFault::kIgnoreTrigger:
    case CameraFault::kNackTrigger:
      return CameraEvent::kTrigger;
    default:
      return CameraEvent::kFrame;
  }
}

void CameraFaultScript::add(const CameraFaultStep& step) {
  check(step);
  const MutexLock lock(mutex_);
  steps_.push_back(step);
}

std::optional<CameraFaultStep> CameraFaultScript::next(CameraEvent event) {
  const MutexLock lock(mutex_);
  if (steps_.empty() || event_of(steps_.front()) != event) return std::nullopt;
  CameraFaultStep& step = steps_.front();
  if (step.after > 0) {
    --step.after;
    return std::nullopt;
  }
  const CameraFaultStep fault = step;
  if (--step.count == 0) {
    steps_.pop_front();
    ++taken_;
  }
  return fault;
}

std::size_t CameraFaultScript::unconsumed() const {
  const MutexLock lock(mutex_);
  return steps_.size();
}

std::string CameraFaultScript::describe_unconsumed() const {
  const MutexLock lock(mutex_);
  std::string text;
  int number = taken_;
  for (const CameraFaultStep& step : steps_) {
    if (!text.empty()) text += '\n';
    text += "camera step " + std::to_string(++number) + ": " + std::string(name_of(step.fault));
    if (step.after > 0) text += ", after " + std::to_string(step.after) + " more";
    text += ", " + std::to_string(step.count) + (step.count == 1 ? " time" : " times") + " to go";
  }
  return text;
}

}  // namespace fvd::sim
