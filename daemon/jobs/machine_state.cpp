#include "daemon/jobs/machine_state.hpp"

namespace fvd {

std::string_view scan_state_name(ScanState state) noexcept {
  switch (state) {
    case ScanState::kPreoperational:
      return "preoperational";
    case ScanState::kInitialized:
      return "initialized";
    case ScanState::kReady:
      return "ready";
    case ScanState::kExecuting:
      return "executing";
    case ScanState::kError:
      return "error";
    case ScanState::kHalted:
      return "halted";
  }
  return "error";
}

namespace {

bool is_allowed(const MachineState& machine, MachineEvent event) noexcept {
  const auto taken = [&](Command command) { return refusal(machine, command) == Refusal::kNone; };
  switch (event) {
    case MachineEvent::kDevicesUp:
    case MachineEvent::kDevicesDown:
    case MachineEvent::kStandstillMeasured:
    case MachineEvent::kMotionSeen:
    case MachineEvent::kStorageGood:
    case MachineEvent::kStorageBad:
    case MachineEvent::kAlarmGone:
    case MachineEvent::kAlarmSeen:
    case MachineEvent::kHalt:
      return true;
    case MachineEvent::kRecipePrepared:
      return taken(Command::kPrepareRecipe);
    case MachineEvent::kJobOffered:
      return taken(Command::kStartJob);
    case MachineEvent::kJobRefused:
    case MachineEvent::kJobAccepted:
      return machine.job == JobStage::kOffered;
    case MachineEvent::kJobAcquired:
    case MachineEvent::kJobEnded:
      return machine.job == JobStage::kHoldsPart || machine.job == JobStage::kAcquired;
    case MachineEvent::kLookStarted:
    case MachineEvent::kMotionStarted:
      return taken(Command::kRunTask);
    case MachineEvent::kTaskEnded:
      return machine.task != TaskState::kNone;
  }
  return false;
}

}  // namespace

std::optional<MachineState> after(MachineState machine, MachineEvent event) noexcept {
  if (!is_allowed(machine, event)) return std::nullopt;
  switch (event) {
    case MachineEvent::kDevicesUp:
      machine.devices = DevicesState::kUp;
      break;
    case MachineEvent::kDevicesDown:
      machine.devices = DevicesState::kDown;
      machine.prepared = false;
      break;
    case MachineEvent::kStandstillMeasured:
      machine.at_rest = true;
      break;
    case MachineEvent::kMotionSeen:
      machine.at_rest = false;
      break;
    case MachineEvent::kRecipePrepared:
      machine.prepared = true;
      break;
    case MachineEvent::kJobOffered:
      machine.job = JobStage::kOffered;
      break;
    case MachineEvent::kJobRefused:
      machine.job = JobStage::kNone;
      break;
    case MachineEvent::kJobAccepted:
      machine.job = JobStage::kHoldsPart;
      break;
    case MachineEvent::kJobAcquired:
      machine.job = JobStage::kAcquired;
      break;
    case MachineEvent::kJobEnded:
      machine.job = JobStage::kNone;
      break;
    case MachineEvent::kLookStarted:
      machine.task = TaskState::kLooks;
      break;
    case MachineEvent::kMotionStarted:
      machine.task = TaskState::kMoves;
      break;
    case MachineEvent::kTaskEnded:
      machine.task = TaskState::kNone;
      break;
    case MachineEvent::kStorageGood:
      machine.storable = true;
      break;
    case MachineEvent::kStorageBad:
      machine.storable = false;
      break;
    case MachineEvent::kAlarmGone:
      machine.alarmed = false;
      break;
    case MachineEvent::kAlarmSeen:
      machine.alarmed = true;
      break;
    case MachineEvent::kHalt:
      machine.halted = true;
      break;
  }
  return machine;
}

}  // namespace fvd
