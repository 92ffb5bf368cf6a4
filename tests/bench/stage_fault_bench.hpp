#pragma once

/// The fault matrix of the stage driver: every drive, either line, every fault.

namespace fvd::test {

struct StageFaultFigures {
  int cases = 0;
  int wrong_values = 0;    ///< positions that were believed and were not true
  int moves_too_many = 0;  ///< motions that nobody commanded
  int surprises = 0;       ///< cases that ended otherwise than they should; the log names them
};

/// Prints what is not as it should be. context: blocks for minutes.
[[nodiscard]] StageFaultFigures run_stage_faults();

}  // namespace fvd::test
