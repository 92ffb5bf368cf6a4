#pragma once

/// The form in which a surface is evaluated.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/image/image.hpp"
#include "core/surface/lateral_kernel.hpp"

namespace fvd::metrology {

/// Heights on a regular grid. x right, y down; (0, 0) is the outer corner of the pixel in column 0 and row 0, so that
/// the point of column i stands at x = (i + 0.5) * pitch_x_um. Moves are cheap; copies are explicit through clone().
struct HeightField {
  Plane<double> z_um;       ///< [height][width]; NaN = hole, never an infinity
  Plane<float> sigma_um;    ///< standard error of a point; of the same shape, NaN in a hole; empty = not known
  double pitch_x_um = 1.0;  ///< > 0
  double pitch_y_um = 1.0;  ///< > 0
  LateralKernel kernel;     ///< what the focus window did to the points; {1} where it is not known

  [[nodiscard]] int width() const { return z_um.width(); }
  [[nodiscard]] int height() const { return z_um.height(); }
  [[nodiscard]] bool has_sigma() const { return !sigma_um.empty(); }
  [[nodiscard]] double x_um(int column) const { return (column + 0.5) * pitch_x_um; }
  [[nodiscard]] double y_um(int row) const { return (row + 0.5) * pitch_y_um; }
  [[nodiscard]] bool is_hole(int column, int row) const { return std::isnan(z_um.at(column, row)); }
  [[nodiscard]] HeightField clone() const { return {z_um.clone(), sigma_um.clone(), pitch_x_um, pitch_y_um, kernel}; }
};

/// The points that belong to a region: 1 inside, 0 outside, of the shape of the field. Empty = every point.
using Region = Plane<std::uint8_t>;

[[nodiscard]] inline bool is_inside(const Region& region, int column, int row) {
  return region.empty() || region.at(column, row) != 0;
}

}  // namespace fvd::metrology
