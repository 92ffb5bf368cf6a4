#pragma once

/// One settled position of a run that verifies the stage.

#include <optional>
#include <vector>

#include "core/hw/axis.hpp"

namespace fvd {

struct StagePoint {
  double time_s = 0.0;        ///< time of the measurement, from any origin
  int run = 0;                ///< 0-based pass over the range
  int direction = 1;          ///< +1 approached from below, -1 from above
  double commanded_um = 0.0;  ///< as asked for
  double quantised_um = 0.0;  ///< as the drive can represent it
  double measured_um = 0.0;   ///< ignored where the stage has no feedback
  double settle_ms = 0.0;     ///< end of the commanded motion to settled
  double move_ms = 0.0;       ///< start of the move to settled
  int polls = 0;              ///< queries of the drive until it was settled
  std::optional<double> temperature_c;
};

struct StageReportOptions {
  FeedbackSource feedback = FeedbackSource::kNone;
  double step_quantum_um = 0.0;         ///< smallest commandable step; 0 = unknown
  double feedback_resolution_um = 0.0;  ///< smallest step of the measured position; 0 = unknown
  std::optional<double> lead_um;        ///< travel per turn of the screw, from the drive profile
};

/// Largest position that is accepted, one kilometre: no stage is that long.
inline constexpr double kLargestPositionUm = 1e9;

/// Throws Error kBadInput naming the first point (0-based) or option that is not finite or out of its range: direction
/// other than +1 and -1, a position beyond kLargestPositionUm, a negative run, number of polls or time, a lead or a
/// resolution that is no length. context: pure.
void check_stage_points(const std::vector<StagePoint>& points, const StageReportOptions& options);

}  // namespace fvd
