#pragma once

/// The machine's state as a pure table. Names follow OPC 40100-1 (Machine Vision), section VisionStateMachine.

#include <array>
#include <optional>
#include <string_view>

namespace fvd {

/// kExecuting is OPC's SingleExecution: a job or a task has the devices. Devices missing or faulty put the machine into
/// kError; it leaves it by itself when they are back, but never moves on its own.
enum class ScanState { kPreoperational, kInitialized, kReady, kExecuting, kError, kHalted };
inline constexpr std::array kAllScanStates{ScanState::kPreoperational, ScanState::kInitialized, ScanState::kReady,
                                           ScanState::kExecuting,      ScanState::kError,       ScanState::kHalted};

/// A task is a command to the devices between two jobs. It ends as kTaskEndedPrepared where a recipe is prepared, as
/// kTaskEnded where none is. A job or a task that ends because a device is lost ends by kDevicesDown.
enum class ScanEvent {
  kDevicesUp,
  kDevicesDown,
  kRecipePrepared,
  kJobStarted,
  kJobEnded,
  kTaskStarted,
  kTaskEnded,
  kTaskEndedPrepared,
  kHalt
};
inline constexpr std::array kAllScanEvents{
    ScanEvent::kDevicesUp,  ScanEvent::kDevicesDown,       ScanEvent::kRecipePrepared,
    ScanEvent::kJobStarted, ScanEvent::kJobEnded,          ScanEvent::kTaskStarted,
    ScanEvent::kTaskEnded,  ScanEvent::kTaskEndedPrepared, ScanEvent::kHalt};

[[nodiscard]] std::string_view scan_state_name(ScanState state) noexcept;

/// The state after the event, or nothing where the event is not allowed.
///
///                | DevicesUp   | DevicesDown | RecipePrepared | Job-, TaskStarted | JobEnded | TaskEnded   | Halt
/// preoperational | initialized | error       | -              | -                 | -        | -           | halted
/// initialized    | initialized | error       | ready          | executing         | -        | -           | halted
/// ready          | ready       | error       | ready          | executing         | -        | -           | halted
/// executing      | -           | error       | -              | JobStarted: same  | ready    | initialized | halted
/// error          | initialized | error       | -              | -                 | -        | -           | halted
/// halted         | -           | -           | -              | -                 | -        | -           | halted
///
/// TaskEndedPrepared leads from executing to ready. A job names its recipe, so it may start from initialized too; the
/// recipe is prepared on the way. A job that is started while a task runs ends the task; the machine stays executing.
[[nodiscard]] constexpr std::optional<ScanState> next_state(ScanState state, ScanEvent event) noexcept {
  using S = ScanState;
  using E = ScanEvent;
  if (event == E::kHalt) return S::kHalted;
  switch (state) {
    case S::kPreoperational:
      if (event == E::kDevicesUp) return S::kInitialized;
      if (event == E::kDevicesDown) return S::kError;
      return std::nullopt;
    case S::kInitialized:
    case S::kReady:
      if (event == E::kDevicesUp) return state;
      if (event == E::kDevicesDown) return S::kError;
      if (event == E::kRecipePrepared) return S::kReady;
      if (event == E::kJobStarted || event == E::kTaskStarted) return S::kExecuting;
      return std::nullopt;
    case S::kExecuting:
      if (event == E::kDevicesDown) return S::kError;
      if (event == E::kJobStarted) return S::kExecuting;
      if (event == E::kJobEnded || event == E::kTaskEndedPrepared) return S::kReady;
      if (event == E::kTaskEnded) return S::kInitialized;
      return std::nullopt;
    case S::kError:
      if (event == E::kDevicesUp) return S::kInitialized;
      if (event == E::kDevicesDown) return S::kError;
      return std::nullopt;
    case S::kHalted:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace fvd
