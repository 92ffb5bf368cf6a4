#include "sim/modbus/scripted_responder.hpp"

#include <string>

namespace fvd::sim {

namespace {

ModbusBytes exception_with(std::span<const std::uint8_t> request, int code) {
  if (request.empty()) return {};
  return {static_cast<std::uint8_t>(request[0] | 0x80U), static_cast<std::uint8_t>(code)};
}

}  // namespace

void ScriptedResponder::befall_drive(const FaultStep& step) {
  if (drive_ == nullptr) return;
  switch (step.fault) {
    case FaultKind::kSilentRefusal:
      return drive_->refuse_moves(1);
    case FaultKind::kStaleInPosition:
      return drive_->hold_in_position(step.delay);
    case FaultKind::kAlarmInMotion:
      return drive_->raise_alarm(step.code);
    case FaultKind::kLimitHit:
      return drive_->limit_hit();
    case FaultKind::kEmergencyStop:
      return drive_->emergency_stop();
    case FaultKind::kPowerCycle:
      return drive_->power_cycle();
    default:
      return;
  }
}

void ScriptedResponder::write_as_another_master(const FaultStep& step) {
  const ModbusException exception = bank_.write(step.to, step.words);
  if (exception == ModbusException::kNone) return;
  script_->failed(step, "the drive refused " + std::to_string(step.words.size()) + " words from register " +
                            std::to_string(step.to) + " on, exception " + std::to_string(static_cast<int>(exception)));
}

LineAnswer ScriptedResponder::answer(std::span<const std::uint8_t> request) {
  LineAnswer answer;
  const bool axis_moves = script_ != nullptr && drive_ != nullptr && drive_->axis_moves();
  const auto step = script_ != nullptr ? script_->next(request, axis_moves) : std::nullopt;
  if (!step) {
    answer.pdu = respond(bank_, request);
    return answer;
  }
  befall_drive(*step);
  switch (step->fault) {
    case FaultKind::kLostRequest:
      return answer;
    case FaultKind::kException:
      answer.pdu = exception_with(request, step->code);
      return answer;
    case FaultKind::kLinkCut:
    case FaultKind::kPowerCycle:
      answer.cut = true;
      answer.outage = step->delay;
      return answer;
    default:
      break;
  }
  if (step->fault == FaultKind::kSecondMaster) write_as_another_master(*step);
  const bool swapped = step->fault == FaultKind::kSwappedWords && drive_ != nullptr;
  if (swapped) drive_->exchange_words(true);
  answer.pdu = respond(bank_, request);
  if (swapped) drive_->exchange_words(false);
  if (step->fault == FaultKind::kExceptionAfter) answer.pdu = exception_with(request, step->code);
  if (step->fault == FaultKind::kLostReply) answer.pdu.clear();
  if (step->fault == FaultKind::kLateReply) answer.late = step->delay;
  answer.wrong_check = step->fault == FaultKind::kWrongCrc;
  answer.truncated = step->fault == FaultKind::kTruncatedFrame;
  return answer;
}

}  // namespace fvd::sim
