#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "core/base/error.hpp"
#include "core/metrology/profile/profile.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
/// Positions this near to a row or column of points stand on it: rounding must not ask for one more neighbour.
constexpr double kOnPoint = 1e-9;

struct Place {
  double x_um;
  double y_um;
};

struct Grid {
  int width;
  int height;
  double pitch_x_um;
  double pitch_y_um;
};

/// Distance between neighbouring points of the grid in the direction of a unit vector.
double pitch_along(const Grid& grid, double unit_x, double unit_y) {
  return 1.0 / std::hypot(unit_x / grid.pitch_x_um, unit_y / grid.pitch_y_um);
}

struct Neighbours {
  int first;
  double second_weight;  ///< 0: the second is not asked for
};

Neighbours neighbours(double position_px) {
  const double whole = std::round(position_px);
  if (std::abs(position_px - whole) < kOnPoint) return {static_cast<int>(whole), 0.0};
  const double below = std::floor(position_px);
  return {static_cast<int>(below), position_px - below};
}

/// heights: called with column and row of a point of the grid.
template <typename Heights>
double sample(const Grid& grid, const Heights& heights, const Place& place) {
  const auto height_or_hole = [&](int column, int row) {
    if (column < 0 || row < 0 || column >= grid.width || row >= grid.height) return kHole;
    return static_cast<double>(heights(column, row));
  };
  const Neighbours x = neighbours(place.x_um / grid.pitch_x_um - 0.5);
  const Neighbours y = neighbours(place.y_um / grid.pitch_y_um - 0.5);
  const auto along_row = [&](int row) {
    const double left = height_or_hole(x.first, row);
    if (x.second_weight == 0.0) return left;
    return (1.0 - x.second_weight) * left + x.second_weight * height_or_hole(x.first + 1, row);
  };
  const double upper = along_row(y.first);
  if (y.second_weight == 0.0) return upper;
  return (1.0 - y.second_weight) * upper + y.second_weight * along_row(y.first + 1);
}

std::string figures(const Place& place) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.6g, %.6g) um", place.x_um, place.y_um);
  return text;
}

void require_inside(const Grid& grid, const Place& place, const char* what) {
  const Place end{grid.width * grid.pitch_x_um, grid.height * grid.pitch_y_um};
  const double slack = 1e-9 * (end.x_um + end.y_um);
  if (place.x_um >= -slack && place.y_um >= -slack && place.x_um <= end.x_um + slack &&
      place.y_um <= end.y_um + slack) {
    return;
  }
  throw Error(ErrorCode::kRegionOutside, std::string("profile: ") + what + " " + figures(place) +
                                             " is outside the field, which ends at " + figures(end));
}

/// The middle of one of count equal pieces of a length.
double middle_of(int piece, int count, double length) { return (piece + 0.5) * length / count; }

template <typename Heights>
Profile extracted(const Grid& field, const Heights& heights, const ProfileLine& line) {
  const double dx = line.to_x_um - line.from_x_um;
  const double dy = line.to_y_um - line.from_y_um;
  const double length = std::hypot(dx, dy);
  const bool numbers = std::isfinite(line.from_x_um) && std::isfinite(line.from_y_um) && std::isfinite(length) &&
                       std::isfinite(line.band_width_um) && line.band_width_um >= 0.0 && line.min_band_share > 0.0;
  if (!numbers)
    throw Error(ErrorCode::kBadInput, "profile: ends and band width must be numbers, the latter not negative");
  require_inside(field, {line.from_x_um, line.from_y_um}, "from");
  require_inside(field, {line.to_x_um, line.to_y_um}, "to");
  const double unit_x = length > 0.0 ? dx / length : 1.0;
  const double unit_y = length > 0.0 ? dy / length : 0.0;
  const auto points = static_cast<int>(std::lround(length / pitch_along(field, unit_x, unit_y)));
  if (points < 2) {
    throw Error(ErrorCode::kBadInput, "profile: from " + figures({line.from_x_um, line.from_y_um}) + " to " +
                                          figures({line.to_x_um, line.to_y_um}) + " are under two points");
  }
  const int across =
      std::max(1, static_cast<int>(std::lround(line.band_width_um / pitch_along(field, -unit_y, unit_x))));
  const double half_band = across > 1 ? 0.5 * line.band_width_um : 0.0;
  for (const double side : {-half_band, half_band}) {
    require_inside(field, {line.from_x_um - side * unit_y, line.from_y_um + side * unit_x}, "corner of the band");
    require_inside(field, {line.to_x_um - side * unit_y, line.to_y_um + side * unit_x}, "corner of the band");
  }

  Profile profile;
  profile.pitch_um = length / points;
  profile.z_um.reserve(static_cast<std::size_t>(points));
  for (int i = 0; i < points; ++i) {
    const double along = middle_of(i, points, length);
    double sum = 0.0;
    int valid = 0;
    for (int j = 0; j < across; ++j) {
      const double offset = across > 1 ? middle_of(j, across, line.band_width_um) - half_band : 0.0;
      const double z = sample(
          field, heights,
          {line.from_x_um + along * unit_x - offset * unit_y, line.from_y_um + along * unit_y + offset * unit_x});
      if (std::isnan(z)) continue;
      sum += z;
      ++valid;
    }
    const bool enough = valid > 0 && valid >= line.min_band_share * across - kOnPoint;
    profile.z_um.push_back(enough ? sum / valid : kHole);
  }
  return profile;
}

}  // namespace

Profile extract_profile(const HeightField& field, const ProfileLine& line) {
  return extracted(
      {field.width(), field.height(), field.pitch_x_um, field.pitch_y_um},
      [&field](int column, int row) { return field.z_um.at(column, row); }, line);
}

Profile extract_profile(const PointField& field, const ProfileLine& line) {
  return extracted({field.width, field.height, field.pitch_x_um, field.pitch_y_um}, field.z_um, line);
}

}  // namespace fvd::metrology
