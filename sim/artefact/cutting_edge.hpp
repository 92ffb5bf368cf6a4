#pragma once

/// A cutting edge in the image: its section along a straight or bent line, with notches and tilt.

#include "sim/artefact/plan.hpp"
#include "sim/artefact/wedge_section.hpp"

namespace fvd::sim {

/// context: any thread.
class EdgeSurface {
 public:
  /// A slope of the tilt across the edge turns its section, one along it raises its line; an edge with a bend takes no
  /// slope along it (bad_parameters).
  EdgeSurface(const CuttingEdge& edge, const Tilt& tilt);

  /// Height over the apex in the middle of the image.
  [[nodiscard]] double height_um(const Place& place) const;
  /// How much deeper the contour lies at this place along the edge, 0 or more; overlapping notches: the deepest.
  [[nodiscard]] double notch_um(double along_um) const;
  /// The apex line at a length along it, and the place beside it.
  [[nodiscard]] Place place(double along_um, double across_um) const;
  [[nodiscard]] const WedgeSection& section() const { return section_; }

 private:
  CuttingEdge edge_;
  Directed direction_;
  double slope_along_;
  WedgeSection section_;
};

}  // namespace fvd::sim
