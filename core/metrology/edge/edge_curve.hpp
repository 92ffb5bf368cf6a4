#pragma once

/// The edge as a line in space, straight or bent.

#include <span>
#include <vector>

#include "core/metrology/edge/edge_planes.hpp"
#include "core/metrology/edge/robust.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology::edge {

/// A place in space, um.
struct SpacePoint {
  double x, y, z;
};

/// The edge at one of its places. A section lies in u and v; v is at right angles to u and to the edge in space.
struct EdgeFrame {
  double x = 0.0, y = 0.0, z = 0.0;  ///< um
  double e_x = 0.0, e_y = 1.0;       ///< along the edge in the image, unit vector
  double u_x = 1.0, u_y = 0.0;       ///< across it, from the rake to the clearance, unit vector
  double tilt = 0.0;                 ///< dz for each um of the image along e
  double stretch = 1.0;              ///< sqrt(1 + tilt^2)

  /// The place at s across and h along v.
  [[nodiscard]] SpacePoint at(double s_um, double h_um) const;
};

/// Where a point of the image lies against the edge.
struct EdgePlace {
  double place_um = 0.0;  ///< parameter of the nearest point of the edge in the image
  double s_um = 0.0;      ///< distance from it, positive on the clearance's side
};

/// Two polynomials over the place along a straight line: the deviation across it in the image, and the height. Beyond
/// the places they were fitted to they go on straight.
class EdgeCurve {
 public:
  /// The straight edge itself, cut to the field and the region.
  EdgeCurve(const StraightEdge& straight, const HeightField& field, const Region& region);
  /// Lays the curve anew through these places, robustly; lowers the degree if there are few of them. points: not empty.
  void fit(std::span<const SpacePoint> points, int degree, const HeightField& field, const Region& region);

  /// False where no point of the edge is in the region.
  [[nodiscard]] bool is_there() const { return to_um_ > from_um_; }
  [[nodiscard]] EdgeFrame frame(double place_um) const;
  /// False only for places of the image further than this from every point of the edge in the region; quick.
  [[nodiscard]] bool may_be_within(double x_um, double y_um, double distance_um) const;
  [[nodiscard]] EdgePlace place_of(double x_um, double y_um) const;
  /// Along the edge in space, from its first point in the region. length(to) is the whole.
  [[nodiscard]] double length_um(double place_um) const;
  [[nodiscard]] double whole_length_um() const { return lengths_.empty() ? 0.0 : lengths_.back(); }
  [[nodiscard]] double place_at_length(double length_um) const;

 private:
  void cut(const HeightField& field, const Region& region);
  void measure_length();

  StraightEdge straight_;
  Polynomial across_;
  Polynomial height_;
  double from_um_ = 0.0;
  double to_um_ = 0.0;
  double most_across_um_ = 0.0;  ///< the bend's largest deviation from the straight line
  std::vector<double> lengths_;  ///< at equal steps from from_um_ to to_um_
};

/// Whether the pixel under this place of the image belongs to the field and the region.
[[nodiscard]] bool is_in_region(const HeightField& field, const Region& region, double x_um, double y_um);

}  // namespace fvd::metrology::edge
