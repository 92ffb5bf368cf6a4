#pragma once

/// The machine's state as a pure table: what is so, what may happen next, and what clients are told. No I/O, no lock.

#include <array>
#include <optional>
#include <string_view>

namespace fvd {

/// What clients see. Names follow OPC 40100-1 (Machine Vision), section VisionStateMachine; kExecuting is OPC's
/// SingleExecution: a job, or a command that moves the stage, has the devices.
enum class ScanState { kPreoperational, kInitialized, kReady, kExecuting, kError, kHalted };
inline constexpr std::array kAllScanStates{ScanState::kPreoperational, ScanState::kInitialized, ScanState::kReady,
                                           ScanState::kExecuting,      ScanState::kError,       ScanState::kHalted};
[[nodiscard]] std::string_view scan_state_name(ScanState state) noexcept;

enum class DevicesState { kUnknown, kDown, kUp };  ///< kUnknown: they are being opened for the first time
enum class TaskState { kNone, kLooks, kMoves };    ///< the command that waits or runs: takes images alone, or moves
/// kOffered: being made durable, no reader sees it yet. kHoldsPart: accepted, until the last slice is taken.
enum class JobStage { kNone, kOffered, kHoldsPart, kAcquired };

struct MachineState {
  bool halted = false;    ///< the daemon is ending
  bool at_rest = false;   ///< the stage's standstill was measured since it was opened
  bool prepared = false;  ///< a recipe was prepared since the devices are up
  DevicesState devices = DevicesState::kUnknown;
  TaskState task = TaskState::kNone;
  JobStage job = JobStage::kNone;
  bool storable = true;  ///< results can be kept
  bool alarmed = false;  ///< the drive has an alarm: nothing is measured until it ends

  bool operator==(const MachineState&) const = default;
};

enum class MachineEvent {
  kDevicesUp,
  kDevicesDown,
  kStandstillMeasured,
  kMotionSeen,  ///< or the stage cannot be seen
  kRecipePrepared,
  kJobOffered,
  kJobRefused,
  kJobAccepted,
  kJobAcquired,
  kJobEnded,
  kLookStarted,
  kMotionStarted,
  kTaskEnded,
  kStorageGood,
  kStorageBad,
  kAlarmGone,
  kAlarmSeen,
  kHalt
};
inline constexpr std::array kAllMachineEvents{
    MachineEvent::kDevicesUp,  MachineEvent::kDevicesDown, MachineEvent::kStandstillMeasured,
    MachineEvent::kMotionSeen, MachineEvent::kJobOffered,  MachineEvent::kRecipePrepared,
    MachineEvent::kJobRefused, MachineEvent::kJobAccepted, MachineEvent::kJobAcquired,
    MachineEvent::kJobEnded,   MachineEvent::kLookStarted, MachineEvent::kMotionStarted,
    MachineEvent::kTaskEnded,  MachineEvent::kStorageGood, MachineEvent::kStorageBad,
    MachineEvent::kAlarmGone,  MachineEvent::kAlarmSeen,   MachineEvent::kHalt};

/// The first row that fits:
///
///   halted                                      -> halted
///   job accepted, or a command that moves       -> executing
///   devices not opened yet                      -> preoperational
///   devices down                                -> error
///   the drive has an alarm                      -> error
///   results cannot be kept                      -> error
///   devices up, recipe prepared                 -> ready
///   devices up                                  -> initialized
[[nodiscard]] constexpr ScanState scan_state(const MachineState& machine) noexcept {
  if (machine.halted) return ScanState::kHalted;
  if (machine.job == JobStage::kHoldsPart || machine.job == JobStage::kAcquired) return ScanState::kExecuting;
  if (machine.task == TaskState::kMoves) return ScanState::kExecuting;
  if (machine.devices == DevicesState::kUnknown) return ScanState::kPreoperational;
  if (machine.devices == DevicesState::kDown || machine.alarmed || !machine.storable) return ScanState::kError;
  return machine.prepared ? ScanState::kReady : ScanState::kInitialized;
}

/// What a PLC reads.
struct Signals {
  bool ready = false;         ///< a job may be started
  bool busy = false;          ///< executing
  bool acquiring = false;     ///< a job holds the part
  bool part_release = false;  ///< the part may be taken: nothing moves, nothing is about to

  bool operator==(const Signals&) const = default;
};

[[nodiscard]] constexpr Signals signals(const MachineState& machine) noexcept {
  const ScanState state = scan_state(machine);
  const bool holds_part = machine.job == JobStage::kHoldsPart;
  return {.ready = state == ScanState::kInitialized || state == ScanState::kReady,
          .busy = state == ScanState::kExecuting,
          .acquiring = state == ScanState::kExecuting && holds_part,
          .part_release = machine.at_rest && machine.task != TaskState::kMoves && !holds_part};
}

/// What a client may ask of the machine.
enum class Command { kStartJob, kRunTask, kPrepareRecipe };
inline constexpr std::array kAllCommands{Command::kStartJob, Command::kRunTask, Command::kPrepareRecipe};

enum class Refusal {
  kNone,
  kShuttingDown,
  kJobRuns,
  kJobOffered,
  kTaskRuns,
  kOpening,
  kDeviceMissing,
  kStorage,
  kAlarm
};

/// Why the machine does not take the command now; the first row that fits:
///
///                        | start job   | run task    | prepare recipe
///   halted               | shutting down for all
///   job accepted         | job runs for all
///   job offered          | job offered | -           | -
///   results not kept     | storage     | -           | -
///   a command looks      | -           | task runs   | -
///   the drive's alarm, devices up | alarm | -: it is reset, and the axis homed | -
///   a command moves      | taken: a job ends it | task runs | taken
///   devices not opened   | opening for all
///   devices down         | device missing for all
///   else                 | taken
[[nodiscard]] constexpr Refusal refusal(const MachineState& machine, Command command) noexcept {
  if (machine.halted) return Refusal::kShuttingDown;
  if (machine.job == JobStage::kHoldsPart || machine.job == JobStage::kAcquired) return Refusal::kJobRuns;
  if (machine.job == JobStage::kOffered && command == Command::kStartJob) return Refusal::kJobOffered;
  if (!machine.storable && command == Command::kStartJob) return Refusal::kStorage;
  if (machine.task != TaskState::kNone && command == Command::kRunTask) return Refusal::kTaskRuns;
  if (machine.alarmed && machine.devices == DevicesState::kUp && command == Command::kStartJob) return Refusal::kAlarm;
  if (machine.task == TaskState::kMoves) return Refusal::kNone;
  if (machine.devices == DevicesState::kUnknown) return Refusal::kOpening;
  if (machine.devices == DevicesState::kDown) return Refusal::kDeviceMissing;
  return Refusal::kNone;
}

/// The state after the event, or nothing where the event is not allowed.
///
///   event              | allowed                    | effect
///   DevicesUp          | always                     | devices up
///   DevicesDown        | always                     | devices down, not prepared
///   StandstillMeasured | always                     | at rest
///   MotionSeen         | always                     | not at rest
///   RecipePrepared     | prepare recipe is taken    | prepared
///   JobOffered         | start job is taken         | job offered
///   JobRefused         | job offered                | no job
///   JobAccepted        | job offered                | job holds the part
///   JobAcquired        | job accepted               | job acquired
///   JobEnded           | job accepted               | no job
///   LookStarted        | run task is taken          | a command looks
///   MotionStarted      | run task is taken          | a command moves
///   TaskEnded          | a command                  | no command
///   StorageGood        | always                     | results can be kept
///   StorageBad         | always                     | results cannot be kept
///   AlarmGone          | always                     | no alarm
///   AlarmSeen          | always                     | the drive has an alarm
///   Halt               | always                     | halted
///
/// A job or a command that ends because a device is lost ends by its own event and DevicesDown, told as one change: the
/// machine goes from executing to error directly. A job may be accepted while a device is lost: it was offered before.
[[nodiscard]] std::optional<MachineState> after(MachineState machine, MachineEvent event) noexcept;

}  // namespace fvd
