#include "core/metrology/operations/region_combine.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

template <typename Combine>
Region combine(const Region& left, const Region& right, Combine both) {
  assert(left.width() == right.width() && left.height() == right.height());
  Region result = Region::unset(left.width(), left.height());
  std::transform(left.pixels().begin(), left.pixels().end(), right.pixels().begin(), result.pixels().begin(),
                 [both](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(both(a != 0, b != 0)); });
  return result;
}

/// Rows from each point to the nearest point outside of the region in its column; `far` where there is none so near.
Plane<int> rows_to_outside(const Region& region, int far) {
  Plane<int> distance = Plane<int>::unset(region.width(), region.height());
  for (int row = 0; row < region.height(); ++row) {
    for (int column = 0; column < region.width(); ++column) {
      const int above = row > 0 ? distance.at(column, row - 1) : far;
      distance.at(column, row) = region.at(column, row) == 0 ? 0 : std::min(above + 1, far);
    }
  }
  for (int row = region.height() - 2; row >= 0; --row) {
    for (int column = 0; column < region.width(); ++column) {
      int& here = distance.at(column, row);
      here = std::min(here, distance.at(column, row + 1) + 1);
    }
  }
  return distance;
}

}  // namespace

Region region_not(const Region& region) {
  Region result = Region::unset(region.width(), region.height());
  std::transform(region.pixels().begin(), region.pixels().end(), result.pixels().begin(),
                 [](std::uint8_t inside) { return static_cast<std::uint8_t>(inside == 0 ? 1 : 0); });
  return result;
}

Region region_union(const Region& left, const Region& right) {
  return combine(left, right, [](bool a, bool b) { return a || b; });
}

Region region_intersection(const Region& left, const Region& right) {
  return combine(left, right, [](bool a, bool b) { return a && b; });
}

// A point is lost where some column has an outside point so near in its own column that the rest of shrink_um reaches
// to the point's column: the Euclidean distance transform, cut off at shrink_um, one interval a column.
Region region_shrink(const Grid& grid, const Region& region, double shrink_um) {
  assert(region.width() == grid.width && region.height() == grid.height);
  if (!(shrink_um >= 0.0) || !std::isfinite(shrink_um)) {
    throw Error(ErrorCode::kBadRecipe, "`shrink_um` of a region must be 0 um or more");
  }
  const double reach_rows = std::min(shrink_um / grid.pitch_y_um, static_cast<double>(grid.height));
  const int far = static_cast<int>(reach_rows) + 2;  // beyond shrink_um, or beyond the image
  const Plane<int> rows = rows_to_outside(region, far);
  Region result = Region::unset(grid.width, grid.height);
  std::vector<int> change(static_cast<std::size_t>(grid.width) + 1);
  for (int row = 0; row < grid.height; ++row) {
    std::fill(change.begin(), change.end(), 0);
    for (int column = 0; column < grid.width; ++column) {
      if (rows.at(column, row) == far) continue;
      const double dy = rows.at(column, row) * grid.pitch_y_um;
      const double left_um2 = shrink_um * shrink_um * (1.0 + kOnBorder_px) - dy * dy;
      if (left_um2 < 0.0) continue;
      const double reach = std::min(std::sqrt(left_um2) / grid.pitch_x_um, static_cast<double>(grid.width));
      const int columns = static_cast<int>(reach);
      ++change[static_cast<std::size_t>(std::max(column - columns, 0))];
      --change[static_cast<std::size_t>(std::min(column + columns + 1, grid.width))];
    }
    int lost = 0;
    for (int column = 0; column < grid.width; ++column) {
      lost += change[static_cast<std::size_t>(column)];
      result.at(column, row) = lost == 0 ? 1 : 0;
    }
  }
  return result;
}

}  // namespace fvd::metrology
