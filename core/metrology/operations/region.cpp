#include "core/metrology/operations/region.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

void require(bool holds, const char* message) {
  if (!holds) throw Error(ErrorCode::kBadRecipe, message);
}

/// The indices [first, end) of the centres (i + 0.5) * pitch in [from, to], cut to [0, count).
struct Indices {
  int first = 0;
  int end = 0;
};

Indices centres_in(double from_um, double to_um, double pitch_um, int count) {
  const double first = std::ceil(from_um / pitch_um - 0.5 - kOnBorder_px);
  const double end = std::floor(to_um / pitch_um - 0.5 + kOnBorder_px) + 1.0;
  const auto cut = [count](double index) {
    return static_cast<int>(std::clamp(index, 0.0, static_cast<double>(count)));
  };
  return {cut(first), cut(end)};
}

void fill_row(Region& region, int row, Indices columns) {
  if (columns.first < columns.end) std::fill(region.row(row) + columns.first, region.row(row) + columns.end, 1);
}

}  // namespace

PixelBlock pixels_in(const Grid& grid, const RectangleUm& rectangle) {
  require(std::isfinite(rectangle.x) && std::isfinite(rectangle.y), "a rectangle's corner is not a finite number");
  require(rectangle.width > 0.0 && rectangle.height > 0.0, "a rectangle's width and height must be greater than 0 um");
  require(std::isfinite(rectangle.width) && std::isfinite(rectangle.height), "a rectangle's size is not finite");
  const Indices columns = centres_in(rectangle.x, rectangle.x + rectangle.width, grid.pitch_x_um, grid.width);
  const Indices rows = centres_in(rectangle.y, rectangle.y + rectangle.height, grid.pitch_y_um, grid.height);
  return {columns.first, columns.end, rows.first, rows.end};
}

Region rectangle_region(const Grid& grid, const RectangleUm& rectangle) {
  const PixelBlock block = pixels_in(grid, rectangle);
  Region region(grid.width, grid.height);
  for (int row = block.first_row; row < block.end_row; ++row) {
    fill_row(region, row, {block.first_column, block.end_column});
  }
  return region;
}

Region circle_region(const Grid& grid, const CircleUm& circle) {
  require(std::isfinite(circle.x) && std::isfinite(circle.y), "a circle's centre is not a finite number");
  require(circle.radius > 0.0 && std::isfinite(circle.radius), "a circle's radius must be greater than 0 um");
  // The border rule is the rectangle's: the circle grows by its tolerance, in every direction alike.
  const double radius = circle.radius + kOnBorder_px * std::min(grid.pitch_x_um, grid.pitch_y_um);
  Region region(grid.width, grid.height);
  for (int row = 0; row < grid.height; ++row) {
    const double dy = (row + 0.5) * grid.pitch_y_um - circle.y;
    if (std::abs(dy) > radius) continue;
    const double half = std::sqrt(radius * radius - dy * dy);
    fill_row(region, row, centres_in(circle.x - half, circle.x + half, grid.pitch_x_um, grid.width));
  }
  return region;
}

Region mask_region(const Grid& grid, const Plane<std::uint8_t>& mask) {
  require(mask.width() == grid.width && mask.height() == grid.height,
          "a region's mask has another size than the surface");
  Region region = Region::unset(grid.width, grid.height);
  std::transform(mask.pixels().begin(), mask.pixels().end(), region.pixels().begin(),
                 [](std::uint8_t value) { return static_cast<std::uint8_t>(value != 0 ? 1 : 0); });
  return region;
}

std::size_t count_points(const Region& region) {
  return static_cast<std::size_t>(
      std::count_if(region.pixels().begin(), region.pixels().end(), [](std::uint8_t inside) { return inside != 0; }));
}

}  // namespace fvd::metrology
