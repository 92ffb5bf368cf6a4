#include "sim/modbus/scripted_responder.hpp"

namespace fvd::sim {

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
      if (!request.empty()) {
        answer.pdu = {static_cast<std::uint8_t>(request[0] | 0x80U), static_cast<std::uint8_t>(step->code)};
      }
      return answer;
    case FaultKind::kLinkCut:
    case FaultKind::kPowerCycle:
      answer.cut = true;
      answer.outage = step->delay;
      return answer;
    default:
      break;
  }
  answer.pdu = respond(bank_, request);
  if (step->fault == FaultKind::kLostReply) answer.pdu.clear();
  if (step->fault == FaultKind::kLateReply) answer.late = step->delay;
  answer.wrong_check = step->fault == FaultKind::kWrongCrc;
  answer.truncated = step->fault == FaultKind::kTruncatedFrame;
  return answer;
}

}  // namespace fvd::sim
