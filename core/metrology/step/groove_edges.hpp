#pragma once

/// The two edges of a groove or a ridge, and the regions A, B, C that ISO 5436-1 puts between them.

#include <array>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/step/refusal.hpp"
#include "core/metrology/step/step_height.hpp"

namespace fvd::metrology {

/// Positions along the traces, from the field's outer corner.
struct GrooveEdges {
  double left_um = 0.0;   ///< in a trace along y the upper one
  double right_um = 0.0;  ///< > left_um
  [[nodiscard]] double width_um() const { return right_um - left_um; }
  [[nodiscard]] double centre_um() const { return 0.5 * (left_um + right_um); }
};

struct FromTo {
  double from_um = 0.0;
  double to_um = 0.0;  ///< > from_um
};

/// A and B: from 1.5 W to W/2 + W/3 from the centre; C: the middle third. ISO 5436-1:2000, 7.1 (type A1), figure 4.
[[nodiscard]] std::array<FromTo, 3> groove_regions(const GrooveEdges& edges);

/// Median over the rows (columns for traces along y) of the band, one height a place along the traces; NaN where under
/// half of the rows are valid. first, last: rows of the band, last included.
[[nodiscard]] std::vector<double> median_trace(const HeightField& field, Across across, int first, int last);

/// The steepest rise and the steepest fall of a trace, each the centre of the part of its flank that is at least half
/// as steep as the steepest. Differences are taken over lag_points, the window's width, and over a gap of holes of up
/// to a tenth of the trace. Refused where rise or fall does not stand out of the other differences by five times their
/// scatter. Own definition (ISO 5436-1 leaves it to the user).
[[nodiscard]] StepOutcome<GrooveEdges> find_groove_edges(const std::vector<double>& trace, double pitch_um,
                                                         int lag_points);

}  // namespace fvd::metrology
