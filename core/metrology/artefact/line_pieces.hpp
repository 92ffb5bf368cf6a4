#pragma once

/// The two edges of a grid's line near one crossing, and where two such lines meet.

#include <optional>

#include "core/image/image.hpp"
#include "core/metrology/artefact/grid_lattice.hpp"

namespace fvd::metrology {

/// Across the lines of one family, as shares of the way from the cells' level to the lines'.
struct LineShape {
  double foot = 0.0;      ///< share between the lines
  double top = 1.0;       ///< share on their middle; below 1 where they are narrower than the focus window
  double width_px = 0.0;  ///< at half of the height
  double edge_px = 0.0;   ///< from foot to top, by the slope of the edge's middle half
};

/// The mean over all lines of a family, half-way between crossings. Absent where there is no line.
[[nodiscard]] std::optional<LineShape> line_shape(const Plane<float>& shares, const GridLattice& lattice, int family);

struct CrossingFit {
  bool expected = false;                 ///< both lines lie in the image on both sides of the crossing
  std::optional<Eigen::Vector2d> place;  ///< absent where what is there does not show it
};

/// The lines of both families near crossing (i, j): per line the places of its left and its right edge and its turn
/// against the lattice, least squares over the points in the edges' ramps on both sides of the crossing. shares: 1 on
/// the lines. context: pure.
[[nodiscard]] CrossingFit fit_crossing(const Plane<float>& shares, const GridLattice& lattice, const LineShape& shape_x,
                                       const LineShape& shape_y, int i, int j);

}  // namespace fvd::metrology
