#pragma once

/// The straight lines of a section's flanks.

#include <optional>

#include "core/metrology/edge/edge_options.hpp"
#include "core/metrology/edge/section_data.hpp"

namespace fvd::metrology::edge {

struct FlankLines {
  double apex_s_um = 0.0;  ///< where they meet
  double apex_h_um = 0.0;
  double rake_rad = 0.0;       ///< rises towards the apex
  double clearance_rad = 0.0;  ///< falls from it
  double noise_um = 0.0;       ///< robust standard deviation of the nodes about them
};

/// Robust lines through the nodes at flank_from_um to flank_to_um. Absent where a flank has under three nodes or the
/// lines do not meet in a convex edge within the section.
[[nodiscard]] std::optional<FlankLines> find_flank_lines(const SectionData& section, const EdgeOptions& options);

}  // namespace fvd::metrology::edge
