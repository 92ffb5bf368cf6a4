#include "daemon/jobs/machine_state.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "gtest/gtest.h"

namespace fvd {
namespace {

using E = MachineEvent;
using S = ScanState;

std::vector<MachineState> all_states() {
  std::vector<MachineState> states;
  for (const bool halted : {false, true}) {
    for (const bool at_rest : {false, true}) {
      for (const bool prepared : {false, true}) {
        for (const auto devices : {DevicesState::kUnknown, DevicesState::kDown, DevicesState::kUp}) {
          for (const auto task : {TaskState::kNone, TaskState::kLooks, TaskState::kMoves}) {
            for (const auto job : {JobStage::kNone, JobStage::kOffered, JobStage::kHoldsPart, JobStage::kAcquired}) {
              for (const bool storable : {false, true}) {
                for (const bool alarmed : {false, true}) {
                  states.push_back({halted, at_rest, prepared, devices, task, job, storable, alarmed});
                }
              }
            }
          }
        }
      }
    }
  }
  return states;
}

std::string text(const MachineState& machine) {
  return std::string(machine.halted ? "halted " : "") + (machine.at_rest ? "at_rest " : "") +
         (machine.storable ? "" : "not storable ") + (machine.alarmed ? "alarmed " : "") +
         (machine.prepared ? "prepared " : "") + "devices " + std::to_string(static_cast<int>(machine.devices)) +
         " task " + std::to_string(static_cast<int>(machine.task)) + " job " +
         std::to_string(static_cast<int>(machine.job));
}

bool has_job(const MachineState& m) { return m.job == JobStage::kHoldsPart || m.job == JobStage::kAcquired; }
bool moves(const MachineState& m) { return m.task == TaskState::kMoves; }

// The tables of the header, typed again as rows: the first that fits.
struct StateRow {
  bool (*fits)(const MachineState&);
  S state;
};
const std::vector<StateRow> kStateRows{
    {[](const MachineState& m) { return m.halted; }, S::kHalted},
    {has_job, S::kExecuting},
    {moves, S::kExecuting},
    {[](const MachineState& m) { return m.devices == DevicesState::kUnknown; }, S::kPreoperational},
    {[](const MachineState& m) { return m.devices == DevicesState::kDown; }, S::kError},
    {[](const MachineState& m) { return m.alarmed; }, S::kError},
    {[](const MachineState& m) { return !m.storable; }, S::kError},
    {[](const MachineState& m) { return m.prepared; }, S::kReady},
    {[](const MachineState&) { return true; }, S::kInitialized},
};

struct RefusalRow {
  bool (*fits)(const MachineState&);
  Refusal start_job;
  Refusal run_task;
  Refusal prepare;
};
constexpr auto kGoOn = static_cast<Refusal>(-1);  // the row says nothing of this command
const std::vector<RefusalRow> kRefusalRows{
    {[](const MachineState& m) { return m.halted; }, Refusal::kShuttingDown, Refusal::kShuttingDown,
     Refusal::kShuttingDown},
    {has_job, Refusal::kJobRuns, Refusal::kJobRuns, Refusal::kJobRuns},
    {[](const MachineState& m) { return m.job == JobStage::kOffered; }, Refusal::kJobOffered, kGoOn, kGoOn},
    {[](const MachineState& m) { return !m.storable; }, Refusal::kStorage, kGoOn, kGoOn},
    {[](const MachineState& m) { return m.task == TaskState::kLooks; }, kGoOn, Refusal::kTaskRuns, kGoOn},
    {[](const MachineState& m) { return m.alarmed && m.devices == DevicesState::kUp; }, Refusal::kAlarm, kGoOn, kGoOn},
    {moves, Refusal::kNone, Refusal::kTaskRuns, Refusal::kNone},
    {[](const MachineState& m) { return m.devices == DevicesState::kUnknown; }, Refusal::kOpening, Refusal::kOpening,
     Refusal::kOpening},
    {[](const MachineState& m) { return m.devices == DevicesState::kDown; }, Refusal::kDeviceMissing,
     Refusal::kDeviceMissing, Refusal::kDeviceMissing},
    {[](const MachineState&) { return true; }, Refusal::kNone, Refusal::kNone, Refusal::kNone},
};

Refusal expected_refusal(const MachineState& machine, Command command) {
  for (const RefusalRow& row : kRefusalRows) {
    if (!row.fits(machine)) continue;
    const Refusal refusal = command == Command::kStartJob  ? row.start_job
                            : command == Command::kRunTask ? row.run_task
                                                           : row.prepare;
    if (refusal != kGoOn) return refusal;
  }
  return Refusal::kNone;
}

struct EventRow {
  E event;
  bool (*allowed)(const MachineState&);
  void (*effect)(MachineState&);
};
bool always(const MachineState&) { return true; }
bool offered(const MachineState& m) { return m.job == JobStage::kOffered; }
template <Command kCommand>
bool taken(const MachineState& m) {
  return expected_refusal(m, kCommand) == Refusal::kNone;
}
const std::vector<EventRow> kEventRows{
    {E::kDevicesUp, always, [](MachineState& m) { m.devices = DevicesState::kUp; }},
    {E::kDevicesDown, always,
     [](MachineState& m) {
       m.devices = DevicesState::kDown;
       m.prepared = false;
     }},
    {E::kStandstillMeasured, always, [](MachineState& m) { m.at_rest = true; }},
    {E::kMotionSeen, always, [](MachineState& m) { m.at_rest = false; }},
    {E::kRecipePrepared, taken<Command::kPrepareRecipe>, [](MachineState& m) { m.prepared = true; }},
    {E::kJobOffered, taken<Command::kStartJob>, [](MachineState& m) { m.job = JobStage::kOffered; }},
    {E::kJobRefused, offered, [](MachineState& m) { m.job = JobStage::kNone; }},
    {E::kJobAccepted, offered, [](MachineState& m) { m.job = JobStage::kHoldsPart; }},
    {E::kJobAcquired, has_job, [](MachineState& m) { m.job = JobStage::kAcquired; }},
    {E::kJobEnded, has_job, [](MachineState& m) { m.job = JobStage::kNone; }},
    {E::kLookStarted, taken<Command::kRunTask>, [](MachineState& m) { m.task = TaskState::kLooks; }},
    {E::kMotionStarted, taken<Command::kRunTask>, [](MachineState& m) { m.task = TaskState::kMoves; }},
    {E::kTaskEnded, [](const MachineState& m) { return m.task != TaskState::kNone; },
     [](MachineState& m) { m.task = TaskState::kNone; }},
    {E::kStorageGood, always, [](MachineState& m) { m.storable = true; }},
    {E::kStorageBad, always, [](MachineState& m) { m.storable = false; }},
    {E::kAlarmGone, always, [](MachineState& m) { m.alarmed = false; }},
    {E::kAlarmSeen, always, [](MachineState& m) { m.alarmed = true; }},
    {E::kHalt, always, [](MachineState& m) { m.halted = true; }},
};

TEST(MachineState, ShowsTheStateOfItsTable) {
  for (const MachineState& machine : all_states()) {
    const auto row = std::find_if(kStateRows.begin(), kStateRows.end(),
                                  [&](const StateRow& candidate) { return candidate.fits(machine); });
    EXPECT_EQ(scan_state(machine), row->state) << text(machine);
  }
}

TEST(MachineState, TakesAndRefusesCommandsAsItsTableSays) {
  for (const MachineState& machine : all_states()) {
    for (const Command command : kAllCommands) {
      EXPECT_EQ(refusal(machine, command), expected_refusal(machine, command))
          << text(machine) << " command " << static_cast<int>(command);
    }
  }
}

TEST(MachineState, FollowsItsTableForEveryStateAndEvent) {
  ASSERT_EQ(kEventRows.size(), kAllMachineEvents.size());
  for (const MachineState& machine : all_states()) {
    for (const EventRow& row : kEventRows) {
      const auto actual = after(machine, row.event);
      ASSERT_EQ(actual.has_value(), row.allowed(machine)) << text(machine) << " event " << static_cast<int>(row.event);
      if (!actual) continue;
      MachineState expected = machine;
      row.effect(expected);
      EXPECT_EQ(*actual, expected) << text(machine) << " event " << static_cast<int>(row.event);
    }
  }
}

TEST(MachineState, ReleasesThePartOnlyAtRestAndUnderNothingThatMoves) {
  for (const MachineState& machine : all_states()) {
    const Signals told = signals(machine);
    const bool may_move = moves(machine) || machine.job == JobStage::kHoldsPart;
    EXPECT_EQ(told.part_release, machine.at_rest && !may_move) << text(machine);
    EXPECT_FALSE(told.ready && may_move) << text(machine);
    EXPECT_FALSE(told.part_release && told.acquiring) << text(machine);
  }
}

TEST(MachineState, IsReadyInTwoStatesAndBusyInOne) {
  for (const MachineState& machine : all_states()) {
    const S state = scan_state(machine);
    const Signals told = signals(machine);
    EXPECT_EQ(told.ready, state == S::kInitialized || state == S::kReady) << text(machine);
    EXPECT_EQ(told.busy, state == S::kExecuting) << text(machine);
    EXPECT_EQ(told.acquiring, state == S::kExecuting && machine.job == JobStage::kHoldsPart) << text(machine);
  }
}

TEST(MachineState, IsNeverReadyWhereItRefusesAJobButForOneThatIsOffered) {
  for (const MachineState& machine : all_states()) {
    if (!signals(machine).ready) continue;
    const Refusal why = refusal(machine, Command::kStartJob);
    EXPECT_TRUE(why == Refusal::kNone || why == Refusal::kJobOffered) << text(machine);
  }
}

TEST(ScanState, NamesAreThoseOfTheStandard) {
  const std::vector<std::string> names{"preoperational", "initialized", "ready", "executing", "error", "halted"};
  for (std::size_t i = 0; i < kAllScanStates.size(); ++i) EXPECT_EQ(scan_state_name(kAllScanStates[i]), names[i]);
}

}  // namespace
}  // namespace fvd
