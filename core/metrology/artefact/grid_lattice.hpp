#pragma once

/// Where a grid of lines lies roughly, from the strongest two waves of a picture of its levels.

#include <optional>

#include <Eigen/Core>

#include "core/image/image.hpp"

namespace fvd::metrology {

/// Crossing (i, j) lies at origin + i * step_x + j * step_y, in pixels from the centre of the first. step_x is within
/// 45 degrees of the image's x, step_y runs downwards.
struct GridLattice {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d step_x = Eigen::Vector2d::UnitX();
  Eigen::Vector2d step_y = Eigen::Vector2d::UnitY();

  [[nodiscard]] Eigen::Vector2d place(double i, double j) const { return origin + i * step_x + j * step_y; }
  /// The inverse of place().
  [[nodiscard]] Eigen::Vector2d index(const Eigen::Vector2d& place) const;
  /// Distance of neighbouring lines, at right angles to them: of those that cross x (0), of those that run along x (1).
  [[nodiscard]] double spacing_px(int family) const;
  /// Unit vectors along a family's lines, and across them towards the next line.
  [[nodiscard]] Eigen::Vector2d along(int family) const;
  [[nodiscard]] Eigen::Vector2d across(int family) const;
};

struct FoundLattice {
  GridLattice lattice;
  bool raised = false;
};

/// shares: 0 to 1 from the lower level to the upper, NaN in holes. Crossings are those of the lines, raised or sunk.
/// Absent where no two waves stand out that could be a grid's. context: pure.
[[nodiscard]] std::optional<FoundLattice> find_lattice(const Plane<float>& shares);

}  // namespace fvd::metrology
