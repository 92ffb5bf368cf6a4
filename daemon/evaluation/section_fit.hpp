#pragma once

/// What was fitted, as lines in a cross section, for pictures.

#include <array>
#include <span>

#include "core/metrology/edge/cutting_edge.hpp"
#include "core/metrology/step/groove_edges.hpp"
#include "core/metrology/step/region_step.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/evaluation/measured_section.hpp"
#include "daemon/result/cross_section.hpp"

namespace fvd {

// Each adds its lines to the section's `fit`, and says what they are. Pictures show measured heights: to a line fitted
// to the evaluated surface what was taken away there (a form, a shift) is added, as the straight line that fits it best
// over the line's extent. Nothing is added where too little is measured, or where the surface has other points than the
// measured one. No value is computed from it; own definition.

/// The line through A and B across the groove, and the one through C. slope: along the section, of the fit.
void add_groove_fit(const MeasurementInput& input, const metrology::GrooveEdges& edges, double slope,
                    CrossSection& section);

/// The line through A and B, and in place of C's line the parabola that fits it best.
void add_rounded_groove_fit(const MeasurementInput& input, const metrology::GrooveEdges& edges, double slope,
                            CrossSection& section);

/// A region as it was fitted.
struct FittedRegion {
  SectionRegion region;
  double mean_z_um = 0.0;  ///< on the evaluated surface
};

/// The plane of each region, where the section crosses it.
void add_plane_fit(const MeasurementInput& input, std::span<const FittedRegion> regions, double slope_x, double slope_y,
                   CrossSection& section);

/// The flanks up to the rounding that the model found between them in the section's place, without the focus window's
/// own rounding. The flanks' lines are fitted anew to the section.
void add_edge_fit(const MeasurementInput& input, const metrology::CuttingEdge& edge, CrossSection& section);

}  // namespace fvd
