#include "tests/bench/stage_fault_bench.hpp"

#include <cstdio>
#include <iostream>

#include "tests/support/fault_case.hpp"

namespace fvd::test {

namespace {

/// A drive that could not be opened or homed before anything went wrong was starved by the machine: a surprise.
FaultOutcome outcome_of(const DriveCase& drive, Transport transport, const FaultCase& fault) {
  try {
    return run_fault_case(drive, transport, fault);
  } catch (const Error& error) {
    FaultOutcome outcome;
    outcome.errors = 2;
    outcome.story = std::string("before the fault: ") + error.what();
    return outcome;
  }
}

}  // namespace

StageFaultFigures run_stage_faults() {
  StageFaultFigures figures;
  for (const DriveCase& drive : kDriveCases) {
    for (const Transport transport : {Transport::kTcp, Transport::kRtu}) {
      for (const FaultCase& fault : fault_cases()) {
        const FaultOutcome outcome = outcome_of(drive, transport, fault);
        ++figures.cases;
        figures.wrong_values += outcome.wrong_values;
        figures.moves_too_many += outcome.moves_too_many;
        const bool right = outcome.errors == (fault.ends_the_move ? 1 : 0) && outcome.unconsumed == 0;
        if (!right) ++figures.surprises;
        if (outcome.wrong_values + outcome.moves_too_many > 0 || !right) {
          std::cout << drive << " " << transport << " " << fault.name << ": " << outcome.story << std::endl;
        }
      }
    }
  }
  std::printf("faults: %d cases, %d wrong values accepted, %d motions too many\n", figures.cases, figures.wrong_values,
              figures.moves_too_many);
  return figures;
}

}  // namespace fvd::test
