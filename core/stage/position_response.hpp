#pragma once

/// The errors of the points grouped by position, from which reversal, repeatability and linearity are computed.

#include <optional>
#include <vector>

#include "core/stage/stage_point.hpp"

namespace fvd {

/// Visits of one position from one side.
struct Approach {
  int visits = 0;
  double mean_error_um = 0.0;
  double sum_of_squares_um2 = 0.0;  ///< of the deviations from the mean
};

struct PositionResponse {
  double quantised_um = 0.0;
  Approach below;  ///< approached from below, direction +1
  Approach above;  ///< approached from above, direction -1
};

/// Largest distance of quantised positions that count as one position: half a quantum, 1e-6 um if it is unknown (0).
/// context: pure.
[[nodiscard]] double same_position_um(double step_quantum_um);

/// One entry per position, in ascending order. error_um: one value per point, same size as `points`. context: pure.
[[nodiscard]] std::vector<PositionResponse> responses(const std::vector<StagePoint>& points,
                                                      const std::vector<double>& error_um, double step_quantum_um);

/// Reversal value B_i = mean from below - mean from above of a position, ISO 230-2:2014; positive where the stage stops
/// higher after a move upwards.
struct ReversalFigures {
  int positions = 0;     ///< visited from both sides
  double mean_um = 0.0;  ///< mean of B_i
  double max_um = 0.0;   ///< largest |B_i|: the reversal value B of the axis in ISO 230-2:2014
};
/// Nothing where no position was visited from both sides. context: pure.
[[nodiscard]] std::optional<ReversalFigures> reversal_figures(const std::vector<PositionResponse>& responses);

/// Spread of repeated visits of a position from the same side: sample standard deviation s. The unidirectional
/// repeatability of ISO 230-2:2014 is R = 4 s.
struct RepeatabilityFigures {
  int groups = 0;             ///< position and side with at least two visits
  double pooled_sd_um = 0.0;  ///< root of the sum of squares over the degrees of freedom of all groups
  double max_sd_um = 0.0;     ///< largest standard deviation of a group
};
/// Nothing where no position was visited twice from a side. context: pure.
[[nodiscard]] std::optional<RepeatabilityFigures> repeatability_figures(const std::vector<PositionResponse>& responses);

}  // namespace fvd
