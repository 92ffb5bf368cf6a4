#pragma once

/// Where measurements looked, for pictures of them.

#include <optional>
#include <span>
#include <string>

#include "core/metrology/edge/cutting_edge.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/result/cross_section.hpp"

namespace fvd {

/// Along the traces in the middle of the band, as wide as the band, with A, B and C.
[[nodiscard]] CrossSection groove_section(const metrology::HeightField& field,
                                          const metrology::GrooveSettings& settings,
                                          const metrology::GrooveEdges& edges);

struct SectionPlace {
  double x_um = 0.0;
  double y_um = 0.0;
};

/// Of a region's points. It has at least one.
[[nodiscard]] SectionPlace centre_of(const metrology::HeightField& field, const metrology::Region& region);

struct SectionRegion {
  std::string name;
  const metrology::Region* points = nullptr;
};

/// Through the centres of the first and the last region to the field's border, one pixel wide; a region from the first
/// to the last of its points on that line. At least two regions, each with a point. Own definition.
[[nodiscard]] CrossSection regions_section(const metrology::HeightField& field, std::span<const SectionRegion> regions);

/// From end to end of the profile.
[[nodiscard]] CrossSection profile_section(const PlannedMeasurement& planned);

/// The middle one of the measured sections; nullptr where none was measured.
[[nodiscard]] const metrology::EdgeSection* middle_section(const metrology::CuttingEdge& edge);

/// Across the edge in the middle one of the measured sections, somewhat further than the flanks are looked at, as wide
/// as a section. Nothing where no section was measured.
[[nodiscard]] std::optional<CrossSection> edge_section(const metrology::CuttingEdge& edge,
                                                       const PlannedMeasurement& planned);

}  // namespace fvd
