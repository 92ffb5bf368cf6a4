#pragma once

/// The step log in a few numbers.

#include "core/stage/step_log.hpp"

namespace fvd {

/// Over the measured steps of one scan. Lengths in um, times in ms. All zero for an empty log.
struct StepSummary {
  int steps = 0;
  double error_mean_um = 0.0;          ///< of measured - quantised
  double error_sd_um = 0.0;            ///< sample standard deviation, 0 with fewer than two steps
  double error_max_um = 0.0;           ///< largest |error|
  double increment_error_sd_um = 0.0;  ///< of measured minus quantised distance of neighbouring measured slices
  double increment_error_max_um = 0.0;
  double move_median_ms = 0.0;
  double move_max_ms = 0.0;
};

/// context: pure.
[[nodiscard]] StepSummary summarize_steps(const StepLog& log);

}  // namespace fvd
