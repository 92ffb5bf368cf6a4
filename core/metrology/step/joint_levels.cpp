#include "core/metrology/step/joint_levels.hpp"

#include <algorithm>
#include <cmath>

namespace fvd::metrology {

namespace {

/// A determinant below this share of the product of its diagonal stands for points on one line.
constexpr double kMinDeterminant = 1e-12;

template <typename Visit>
void each_point(const HeightField& field, const PointGroups& groups, const Visit& visit) {
  for (int row = 0; row < groups.group.height(); ++row) {
    for (int column = 0; column < groups.group.width(); ++column) {
      const int group = groups.group.at(column, row);
      if (group == 0 || field.is_hole(groups.left + column, groups.top + row)) continue;
      visit(group, groups.left + column, groups.top + row);
    }
  }
}

}  // namespace

bool JointLevels::invert(const std::array<double, 3>& scatter, SlopeAxes axes) {
  const auto [xx, xy, yy] = scatter;
  switch (axes) {
    case SlopeAxes::kNone:
      return true;
    case SlopeAxes::kX:
      if (!(xx > 0.0)) return false;
      inverse_ = {1.0 / xx, 0.0, 0.0};
      return true;
    case SlopeAxes::kY:
      if (!(yy > 0.0)) return false;
      inverse_ = {0.0, 0.0, 1.0 / yy};
      return true;
    case SlopeAxes::kBoth:
      break;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > kMinDeterminant * xx * yy)) return false;
  inverse_ = {yy / determinant, -xy / determinant, xx / determinant};
  return true;
}

std::optional<JointLevels> JointLevels::fit(const HeightField& field, const PointGroups& groups, SlopeAxes axes,
                                            const std::vector<int>& from) {
  JointLevels levels;
  levels.centres_.resize(static_cast<std::size_t>(groups.count));
  each_point(field, groups, [&](int group, int column, int row) {
    Centre& centre = levels.centres_[index(group)];
    ++centre.points;
    centre.x_um += field.x_um(column);
    centre.y_um += field.y_um(row);
    centre.z_um += field.z_um.at(column, row);
  });
  for (int group = 1; group <= groups.count; ++group) {
    Centre& centre = levels.centres_[index(group)];
    if (centre.points == 0) return std::nullopt;
    centre.x_um /= centre.points;
    centre.y_um /= centre.points;
    centre.z_um /= centre.points;
    centre.decides = from.empty() || std::find(from.begin(), from.end(), group) != from.end();
  }
  std::array<double, 3> scatter{};
  std::array<double, 2> products{};
  each_point(field, groups, [&](int group, int column, int row) {
    const Centre& centre = levels.centres_[index(group)];
    if (!centre.decides) return;
    const double x = field.x_um(column) - centre.x_um;
    const double y = field.y_um(row) - centre.y_um;
    const double z = field.z_um.at(column, row) - centre.z_um;
    scatter[0] += x * x;
    scatter[1] += x * y;
    scatter[2] += y * y;
    products[0] += x * z;
    products[1] += y * z;
  });
  if (!levels.invert(scatter, axes)) return std::nullopt;
  levels.slope_ = levels.slope_change(products[0], products[1]);
  return levels;
}

std::array<double, 2> JointLevels::slope_change(double x, double y) const {
  return {inverse_[0] * x + inverse_[1] * y, inverse_[1] * x + inverse_[2] * y};
}

double JointLevels::difference_um(int upper, int lower) const {
  const Centre& u = centres_.at(index(upper));
  const Centre& l = centres_.at(index(lower));
  return u.z_um - l.z_um - slope_[0] * (u.x_um - l.x_um) - slope_[1] * (u.y_um - l.y_um);
}

double JointLevels::correlation_factor(int upper, int lower) const {
  const Centre& u = centres_.at(index(upper));
  const Centre& l = centres_.at(index(lower));
  const double x = u.x_um - l.x_um;
  const double y = u.y_um - l.y_um;
  const auto change = slope_change(x, y);
  const double alone = 1.0 / u.points + 1.0 / l.points;
  return std::sqrt((alone + x * change[0] + y * change[1]) / alone);
}

WeightMap JointLevels::weights(const HeightField& field, const PointGroups& groups, int upper, int lower,
                               double per_difference, std::array<double, 2> per_slope) const {
  const Centre& u = centres_.at(index(upper));
  const Centre& l = centres_.at(index(lower));
  WeightMap map;
  map.left = groups.left;
  map.top = groups.top;
  map.weights = Plane<double>(groups.group.width(), groups.group.height(), 0.0);
  // The slopes move the difference by the distance of the centres.
  const double by_slope_x = per_slope[0] - per_difference * (u.x_um - l.x_um);
  const double by_slope_y = per_slope[1] - per_difference * (u.y_um - l.y_um);
  each_point(field, groups, [&](int group, int column, int row) {
    const Centre& centre = centres_[index(group)];
    double weight = 0.0;
    if (group == upper) weight += per_difference / u.points;
    if (group == lower) weight -= per_difference / l.points;
    if (centre.decides) {
      const auto change = slope_change(field.x_um(column) - centre.x_um, field.y_um(row) - centre.y_um);
      weight += by_slope_x * change[0] + by_slope_y * change[1];
    }
    map.weights.at(column - groups.left, row - groups.top) = weight;
  });
  return map;
}

}  // namespace fvd::metrology
