#include "sim/artefact/cutting_edge.hpp"

#include <algorithm>
#include <cmath>

namespace fvd::sim {

EdgeSurface::EdgeSurface(const CuttingEdge& edge, const Tilt& tilt)
    : edge_(edge),
      direction_(edge.direction_deg),
      slope_along_(direction_.along(tilt)),
      section_(edge, degrees(std::atan(direction_.across(tilt)))) {}

double EdgeSurface::notch_um(double along_um) const {
  double deepest = 0.0;
  for (const Notch& notch : edge_.notches) {
    const double from_middle = std::abs(along_um - notch.position_um);
    if (from_middle >= notch.width_um) continue;
    const double share = std::cos(std::numbers::pi * from_middle / (2.0 * notch.width_um));
    deepest = std::max(deepest, notch.depth_um * share * share);
  }
  return deepest;
}

/// A section w(s) turned with its line by e about the horizontal across it lies at z = along tan e + w(s) / cos e.
double EdgeSurface::height_um(const Place& place) const {
  double along = direction_.along(place);
  double across = direction_.across(place);
  if (edge_.bend_radius_um) {
    const double radius = std::abs(*edge_.bend_radius_um);
    const double side = std::copysign(1.0, *edge_.bend_radius_um);
    const double inwards = radius - side * across;
    across = side * (radius - std::hypot(along, inwards));
    along = radius * std::atan2(along, inwards);
  }
  return along * slope_along_ +
         section_.height_um(across, notch_um(along)) * std::sqrt(1.0 + slope_along_ * slope_along_);
}

Place EdgeSurface::place(double along_um, double across_um) const {
  if (!edge_.bend_radius_um) return direction_.at(along_um, across_um);
  const double radius = std::abs(*edge_.bend_radius_um);
  const double side = std::copysign(1.0, *edge_.bend_radius_um);
  const double from_centre = radius - side * across_um;
  const double angle = along_um / radius;
  return direction_.at(from_centre * std::sin(angle), side * (radius - from_centre * std::cos(angle)));
}

}  // namespace fvd::sim
