#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/operations/region.hpp"

namespace fvd::metrology {
namespace {

/// One side of the polygon, from its upper end to its lower end.
struct Side {
  PointUm top;
  PointUm bottom;
  double length_um = 0.0;

  Side(PointUm a, PointUm b) : top(a.y <= b.y ? a : b), bottom(a.y <= b.y ? b : a) {
    length_um = std::hypot(b.x - a.x, b.y - a.y);
  }

  /// Distance of the point from the side's line; positive to the right of it in the image.
  [[nodiscard]] double distance_um(double x, double y) const {
    return ((x - top.x) * (bottom.y - top.y) - (y - top.y) * (bottom.x - top.x)) / length_um;
  }
};

class PolygonRow {
 public:
  PolygonRow(const Grid& grid, int row)
      : grid_(grid),
        y_um_((row + 0.5) * grid.pitch_y_um),
        tolerance_um_(kOnBorder_px * std::min(grid.pitch_x_um, grid.pitch_y_um)),
        toggles_(static_cast<std::size_t>(grid.width) + 1) {}

  /// Every centre to the right of the side changes between inside and outside. The lower end does not belong to a side,
  /// so that a ray through a corner counts once.
  void cross(const Side& side) {
    if (side.top.y > y_um_ || side.bottom.y <= y_um_) return;
    const double share = (y_um_ - side.top.y) / (side.bottom.y - side.top.y);
    int column = column_near(side.top.x + share * (side.bottom.x - side.top.x));
    while (column > 0 && side.distance_um(x_um(column - 1), y_um_) > 0.0) --column;
    while (column < grid_.width && side.distance_um(x_um(column), y_um_) <= 0.0) ++column;
    toggles_[static_cast<std::size_t>(column)] ^= 1U;
  }

  void write(std::uint8_t* inside) const {
    std::uint8_t state = 0;
    for (int column = 0; column < grid_.width; ++column) {
      state ^= toggles_[static_cast<std::size_t>(column)];
      inside[column] = state;
    }
  }

  /// Centres on the side are inside, whatever the rays say.
  void add_border(const Side& side, std::uint8_t* inside) const {
    if (side.top.y > y_um_ + tolerance_um_ || side.bottom.y < y_um_ - tolerance_um_) return;
    double from_um = std::min(side.top.x, side.bottom.x) - tolerance_um_;
    double to_um = std::max(side.top.x, side.bottom.x) + tolerance_um_;
    const double dy = side.bottom.y - side.top.y;
    if (dy > 0.0) {  // the part of the side within the tolerance of this row
      const double x = side.top.x + (y_um_ - side.top.y) / dy * (side.bottom.x - side.top.x);
      const double reach = tolerance_um_ * side.length_um / dy;
      from_um = std::max(from_um, x - reach);
      to_um = std::min(to_um, x + reach);
    }
    const int first = std::max(column_near(from_um) - 1, 0);
    for (int column = first; column < grid_.width && x_um(column) <= to_um; ++column) {
      if (x_um(column) >= from_um) inside[column] = 1;
    }
  }

 private:
  [[nodiscard]] double x_um(int column) const { return (column + 0.5) * grid_.pitch_x_um; }
  [[nodiscard]] int column_near(double x) const {
    return static_cast<int>(std::clamp(std::floor(x / grid_.pitch_x_um), 0.0, static_cast<double>(grid_.width)));
  }

  const Grid& grid_;
  double y_um_;
  double tolerance_um_;
  std::vector<std::uint8_t> toggles_;
};

}  // namespace

std::optional<std::string> polygon_problem(std::span<const PointUm> corners) {
  if (corners.size() < 3) return "a polygon needs at least three points";
  double size = 0.0;
  for (const PointUm& corner : corners) {
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y)) return "a polygon's point is not a finite number";
    size = std::max({size, std::abs(corner.x - corners[0].x), std::abs(corner.y - corners[0].y)});
  }
  // Spanned by the point farthest from the first one: all others on its line, and the polygon has no inside.
  PointUm far = corners[0];
  const auto reach = [&](const PointUm& p) { return std::hypot(p.x - corners[0].x, p.y - corners[0].y); };
  for (const PointUm& corner : corners) {
    if (reach(corner) > reach(far)) far = corner;
  }
  for (const PointUm& p : corners) {
    const double area = (far.x - corners[0].x) * (p.y - corners[0].y) - (far.y - corners[0].y) * (p.x - corners[0].x);
    if (std::abs(area) > 1e-12 * size * size) return std::nullopt;
  }
  return "all points of a polygon lie on one line";
}

Region polygon_region(const Grid& grid, std::span<const PointUm> corners) {
  if (const auto problem = polygon_problem(corners)) throw Error(ErrorCode::kBadRecipe, *problem);
  std::vector<Side> sides;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Side side(corners[i], corners[(i + 1) % corners.size()]);
    if (side.length_um > 0.0) sides.push_back(side);
  }
  Region region = Region::unset(grid.width, grid.height);
  for (int row = 0; row < grid.height; ++row) {
    PolygonRow scan(grid, row);
    for (const Side& side : sides) scan.cross(side);
    scan.write(region.row(row));
    for (const Side& side : sides) scan.add_border(side, region.row(row));
  }
  return region;
}

}  // namespace fvd::metrology
