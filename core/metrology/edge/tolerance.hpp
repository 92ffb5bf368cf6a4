#pragma once

/// The rounding's ends by a tolerance: where the contour leaves the flanks' lines.

#include <optional>

#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/flank_lines.hpp"
#include "core/metrology/edge/section_data.hpp"

namespace fvd::metrology::edge {

struct ToleranceFigures {
  double beta_deg = 0.0;
  double s_gamma_um = 0.0;
  double s_alpha_um = 0.0;
  double delta_r_um = 0.0;
  double phi_deg = 0.0;  ///< positive towards the rake, that is where S_gamma > S_alpha
};

/// From the apex outwards on each side, the first place where the contour is nearer to its flank's line than
/// tolerance_um, linear between nodes, projected on the line. Absent where it never is within the section. Own
/// definition.
[[nodiscard]] std::optional<ToleranceFigures> measure_by_tolerance(const SectionData& section, const FlankLines& lines,
                                                                   const EdgeOptions& options);

}  // namespace fvd::metrology::edge
