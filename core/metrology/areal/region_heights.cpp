#include "core/metrology/areal/region_heights.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

struct Bounds {
  int left = std::numeric_limits<int>::max();
  int right = -1;
  int top = std::numeric_limits<int>::max();
  int bottom = -1;
};

/// Counts the points and tells the rectangle that the valid ones take.
Bounds survey(const HeightField& field, const Region& region, RegionHeights& cut) {
  Bounds bounds;
  for (int y = 0; y < field.height(); ++y) {
    const std::size_t before = cut.points;
    for (int x = 0; x < field.width(); ++x) {
      if (!is_inside(region, x, y)) continue;
      ++cut.region_points;
      if (field.is_hole(x, y)) continue;
      ++cut.points;
      bounds.left = std::min(bounds.left, x);
      bounds.right = std::max(bounds.right, x);
    }
    if (cut.points == before) continue;
    bounds.top = std::min(bounds.top, y);
    bounds.bottom = y;
  }
  return bounds;
}

}  // namespace

std::vector<double> RegionHeights::valid_heights_um() const {
  std::vector<double> heights;
  heights.reserve(points);
  for (int y = 0; y < height; ++y) {
    const double* from = row(y);
    std::copy_if(from, from + width, std::back_inserter(heights), [](double z) { return !std::isnan(z); });
  }
  return heights;
}

RegionHeights cut_region(const HeightField& field, const Region& region) {
  assert(region.empty() || (region.width() == field.width() && region.height() == field.height()));
  RegionHeights cut;
  cut.pitch_x_um = field.pitch_x_um;
  cut.pitch_y_um = field.pitch_y_um;
  const Bounds bounds = survey(field, region, cut);
  if (cut.points == 0) return cut;
  constexpr int kMargin = RegionHeights::kMargin;
  cut.width = bounds.right - bounds.left + 1;
  cut.height = bounds.bottom - bounds.top + 1;
  cut.z_um = Plane<double>(cut.width + 2 * kMargin, cut.height + 2 * kMargin, kHole);
  for (int y = 0; y < cut.height; ++y) {
    double* to = cut.z_um.row(y + kMargin) + kMargin;
    for (int x = 0; x < cut.width; ++x) {
      const int column = bounds.left + x;
      if (is_inside(region, column, bounds.top + y)) to[x] = field.z_um.at(column, bounds.top + y);
    }
  }
  return cut;
}

}  // namespace fvd::metrology
