#pragma once

/// One fault in the middle of a scan's moves, and whether a wrong position was accepted because of it.

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd::test {

struct FaultOutcome {
  int wrong_values = 0;        ///< positions reported as measured that the axis was not at
  int moves_too_many = 0;      ///< motions the drive executed beyond those commanded
  int errors = 0;              ///< moves that ended with an error
  std::string story;           ///< description of everything unexpected
  std::size_t unconsumed = 0;  ///< faults that never happened
};

/// A fault, the request that it strikes, and whether the move must end with an error.
struct FaultCase {
  const char* name;
  sim::FaultStep step;
  bool ends_the_move;           ///< the fault is one that no driver may hide
  bool another_master = false;  ///< in place of the step: somebody else writes a target
};

inline std::vector<FaultCase> fault_cases() {
  using sim::FaultKind;
  using sim::FaultOn;
  using std::chrono::milliseconds;
  const auto step = [](FaultOn on, FaultKind fault, milliseconds delay = milliseconds(0), int code = 0, int count = 1) {
    sim::FaultStep one;
    one.on = on;
    one.fault = fault;
    one.delay = delay;
    one.code = code;
    one.count = count;
    return one;
  };
  return {
      {"LateReplyToRead", step(FaultOn::kRead, FaultKind::kLateReply, milliseconds(220)), false},
      {"LateReplyToWrite", step(FaultOn::kWrite, FaultKind::kLateReply, milliseconds(220)), false},
      {"LostReplyToRead", step(FaultOn::kRead, FaultKind::kLostReply), false},
      {"LostReplyToWrite", step(FaultOn::kWrite, FaultKind::kLostReply), false},
      {"LostRead", step(FaultOn::kRead, FaultKind::kLostRequest), false},
      {"LostWrite", step(FaultOn::kWrite, FaultKind::kLostRequest), false},
      {"WrongCrcOfRead", step(FaultOn::kRead, FaultKind::kWrongCrc), false},
      {"WrongCrcOfWrite", step(FaultOn::kWrite, FaultKind::kWrongCrc), false},
      {"TruncatedRead", step(FaultOn::kRead, FaultKind::kTruncatedFrame), false},
      {"TruncatedWrite", step(FaultOn::kWrite, FaultKind::kTruncatedFrame), false},
      {"ExceptionToWrite", step(FaultOn::kWrite, FaultKind::kException, milliseconds(0), 4), true},
      {"SilentRefusal", step(FaultOn::kWrite, FaultKind::kSilentRefusal), true},
      {"StaleInPosition", step(FaultOn::kWrite, FaultKind::kStaleInPosition, milliseconds(30)), false},
      {"AlarmInMotion", step(FaultOn::kRead, FaultKind::kAlarmInMotion, milliseconds(0), 0x10), true},
      {"EmergencyStop", step(FaultOn::kRead, FaultKind::kEmergencyStop), true},
      {"LinkCut", step(FaultOn::kAny, FaultKind::kLinkCut, milliseconds(80)), false},
      {"LinkCutForLong", step(FaultOn::kAny, FaultKind::kLinkCut, milliseconds(5000)), true},
      {"AcknowledgeToWrite", step(FaultOn::kWrite, FaultKind::kException, milliseconds(0), 0x05), false},
      {"BusyToRead", step(FaultOn::kRead, FaultKind::kException, milliseconds(0), 0x06, 4), false},
      {"BusyToWrite", step(FaultOn::kWrite, FaultKind::kException, milliseconds(0), 0x06), false},
      {"NoPathToRead", step(FaultOn::kRead, FaultKind::kException, milliseconds(0), 0x0A, 3), false},
      {"NoPathToWrite", step(FaultOn::kWrite, FaultKind::kException, milliseconds(0), 0x0A), false},
      {"GatewayGaveUpOnRead", step(FaultOn::kRead, FaultKind::kException, milliseconds(0), 0x0B, 2), false},
      {"GatewayGaveUpOnWrite", step(FaultOn::kWrite, FaultKind::kException, milliseconds(0), 0x0B), false},
      {"AnotherMastersTarget", {}, true, true},
      {"PowerCycle", step(FaultOn::kRead, FaultKind::kPowerCycle, milliseconds(60)), true},
  };
}

/// Six moves of 10 um; the fault strikes from the third on. A measured position is wrong if the true one differs by
/// more than one and a half settle windows.
inline FaultOutcome run_fault_case(const DriveCase& drive, Transport transport, const FaultCase& fault) {
  constexpr double kTolerance_um = 0.75;
  using std::chrono::milliseconds;
  SimulatedDrive plant(drive, transport);
  FaultOutcome outcome;
  std::ostringstream story;
  auto stage = plant.open_homed();
  const int before = plant.drive().moves();
  const SettleCriterion criterion{
      .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(10), .timeout = milliseconds(2500)};
  int commanded = 0;
  for (int i = 1; i <= 6; ++i) {
    if (i == 3 && fault.another_master) (void)plant.write_target_as_another_master(12345);
    if (i == 3 && !fault.another_master) plant.faults().add(fault.step);
    const double target_um = 10.0 * i;
    ++commanded;
    try {
      const MoveRecord move = stage->move_to(Micrometers{target_um}, criterion, {});
      const HostTime now = HostClock::now();
      const PositionMean mean = stage->mean_position(now, now + milliseconds(5));
      const double true_um = plant.axis().true_position_um(HostClock::now());
      for (const double value : {move.position.value, mean.mean.value}) {
        if (std::abs(value - true_um) <= kTolerance_um) continue;
        ++outcome.wrong_values;
        story << "move " << i << ": measured " << value << " um, true " << true_um << " um; ";
      }
      if (std::abs(true_um - target_um) > kTolerance_um) {
        ++outcome.wrong_values;
        story << "move " << i << ": settled at " << true_um << " um for " << target_um << " um; ";
      }
    } catch (const Error& error) {
      ++outcome.errors;
      story << "move " << i << ": " << error.what() << "; ";
      break;  // what a scan does
    }
  }
  outcome.moves_too_many = std::max(0, plant.drive().moves() - before - commanded);
  outcome.unconsumed = plant.faults().unconsumed();
  outcome.story = story.str();
  return outcome;
}

}  // namespace fvd::test
