#pragma once

/// Regions drawn on a surface: rectangle, polygon, circle, mask.

#include <optional>
#include <span>
#include <string>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

/// In um from the outer corner of pixel (0, 0), x right, y down.
struct PointUm {
  double x = 0.0;
  double y = 0.0;
};
struct RectangleUm {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};
struct CircleUm {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
};

/// The points of a surface without their heights.
struct Grid {
  int width = 0;
  int height = 0;
  double pitch_x_um = 1.0;
  double pitch_y_um = 1.0;
};

[[nodiscard]] inline Grid grid_of(const HeightField& field) {
  return {field.width(), field.height(), field.pitch_x_um, field.pitch_y_um};
}

/// A centre within 1e-9 pixels of a region's border lies on it, and a centre on the border lies in the region.
inline constexpr double kOnBorder_px = 1e-9;

/// The pixels whose centre lies in a rectangle: columns [first_column, end_column), rows alike; may be empty.
struct PixelBlock {
  int first_column = 0;
  int end_column = 0;
  int first_row = 0;
  int end_row = 0;

  [[nodiscard]] bool empty() const { return first_column >= end_column || first_row >= end_row; }
};
[[nodiscard]] PixelBlock pixels_in(const Grid& grid, const RectangleUm& rectangle);

/// Why the polygon encloses nothing or cannot be drawn; absent where it is fine. Needs at least three points, all
/// finite, not all on one line. Sides may cross: a point is inside where a ray from it crosses an odd number of sides.
[[nodiscard]] std::optional<std::string> polygon_problem(std::span<const PointUm> corners);

/// A point belongs to the region where its centre lies in it. Parts outside of the image are left out; a region may be
/// empty of points. Throws Error(kBadRecipe): a width, height or radius that is not > 0, a number that is not finite, a
/// polygon with a problem. context: pure.
[[nodiscard]] Region rectangle_region(const Grid& grid, const RectangleUm& rectangle);
[[nodiscard]] Region circle_region(const Grid& grid, const CircleUm& circle);
[[nodiscard]] Region polygon_region(const Grid& grid, std::span<const PointUm> corners);

/// The points where the mask is not 0. Throws Error(kBadRecipe) where it has another size than the grid.
[[nodiscard]] Region mask_region(const Grid& grid, const Plane<std::uint8_t>& mask);

[[nodiscard]] std::size_t count_points(const Region& region);

}  // namespace fvd::metrology
