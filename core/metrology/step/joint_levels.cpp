#include "core/metrology/step/joint_levels.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace fvd::metrology {
namespace {

/// Points whose squared distances from their centres are below this share of a pixel do not spread in that direction,
/// and below this share of both directions' product they lie on one line.
constexpr double kNoSpread = 1e-10;

/// Calls visit(group, column, row, count) for every run of points of one group in a row; column and row are the
/// field's. Some of the points may be holes.
template <typename Visit>
void for_each_run(const PointGroups& groups, const Visit& visit) {
  const int width = groups.group.width();
  for (int row = 0; row < groups.group.height(); ++row) {
    const std::uint8_t* group = groups.group.row(row);
    for (int from = 0; from < width;) {
      int to = from + 1;
      while (to < width && group[to] == group[from]) ++to;
      if (group[from] != 0) visit(group[from], groups.left + from, groups.top + row, to - from);
      from = to;
    }
  }
}

void check(const HeightField& field, const PointGroups& groups) {
  assert(groups.count >= 1 && groups.left >= 0 && groups.top >= 0);
  assert(groups.left + groups.group.width() <= field.width() && groups.top + groups.group.height() <= field.height());
}

}  // namespace

std::optional<JointLevels> JointLevels::fit(const HeightField& field, const PointGroups& groups, SlopeAxes axes,
                                            const std::vector<int>& from) {
  check(field, groups);
  JointLevels levels;
  levels.centres_.resize(static_cast<std::size_t>(groups.count));
  for (int group = 1; group <= groups.count; ++group) {
    levels.centres_[index(group)].decides = from.empty() || std::find(from.begin(), from.end(), group) != from.end();
  }
  // Each run is summed by itself, so that the sum of millions of points keeps its digits.
  std::vector<std::array<double, 4>> means(levels.centres_.size());
  for_each_run(groups, [&](int group, int column, int row, int count) {
    const double* z = field.z_um.row(row) + column;
    std::array<double, 3> sum{};
    for (int i = 0; i < count; ++i) {
      const bool is_hole = std::isnan(z[i]);
      sum[0] += is_hole ? 0.0 : 1.0;
      sum[1] += is_hole ? 0.0 : field.x_um(column + i);
      sum[2] += is_hole ? 0.0 : z[i];
    }
    std::array<double, 4>& mean = means[index(group)];
    mean[0] += sum[0];
    mean[1] += sum[1];
    mean[2] += sum[0] * field.y_um(row);
    mean[3] += sum[2];
  });
  for (std::size_t i = 0; i < means.size(); ++i) {
    const std::array<double, 4>& sum = means[i];
    if (sum[0] == 0.0) return std::nullopt;
    Centre& centre = levels.centres_[i];
    centre.points = static_cast<int>(sum[0]);
    centre.x_um = sum[1] / sum[0];
    centre.y_um = sum[2] / sum[0];
    centre.z_um = sum[3] / sum[0];
  }
  if (axes == SlopeAxes::kNone) return levels;

  std::array<double, 5> scatter{};
  for_each_run(groups, [&](int group, int column, int row, int count) {
    const double* z = field.z_um.row(row) + column;
    const Centre& centre = levels.centres_[index(group)];
    if (!centre.decides) return;
    std::array<double, 5> sum{};
    for (int i = 0; i < count; ++i) {
      const bool is_hole = std::isnan(z[i]);
      const double dx = is_hole ? 0.0 : field.x_um(column + i) - centre.x_um;
      const double dz = is_hole ? 0.0 : z[i] - centre.z_um;
      sum[0] += dx * dx;
      sum[1] += dx;
      sum[2] += is_hole ? 0.0 : 1.0;
      sum[3] += dx * dz;
      sum[4] += dz;
    }
    const double dy = field.y_um(row) - centre.y_um;
    scatter[0] += sum[0];
    scatter[1] += sum[1] * dy;
    scatter[2] += sum[2] * dy * dy;
    scatter[3] += sum[3];
    scatter[4] += sum[4] * dy;
  });
  if (axes != SlopeAxes::kY && scatter[0] <= kNoSpread * field.pitch_x_um * field.pitch_x_um) return std::nullopt;
  if (axes != SlopeAxes::kX && scatter[2] <= kNoSpread * field.pitch_y_um * field.pitch_y_um) return std::nullopt;
  if (!levels.invert({scatter[0], scatter[1], scatter[2]}, axes)) return std::nullopt;
  levels.slope_ = levels.slope_change(scatter[3], scatter[4]);
  return levels;
}

bool JointLevels::invert(const std::array<double, 3>& scatter, SlopeAxes axes) {
  const auto [xx, xy, yy] = scatter;
  if (axes == SlopeAxes::kX) inverse_ = {1.0 / xx, 0.0, 0.0};
  if (axes == SlopeAxes::kY) inverse_ = {0.0, 0.0, 1.0 / yy};
  if (axes != SlopeAxes::kBoth) return true;
  const double determinant = xx * yy - xy * xy;
  if (determinant <= kNoSpread * xx * yy) return false;
  inverse_ = {yy / determinant, -xy / determinant, xx / determinant};
  return true;
}

std::array<double, 2> JointLevels::slope_change(double x, double y) const {
  return {inverse_[0] * x + inverse_[1] * y, inverse_[1] * x + inverse_[2] * y};
}

double JointLevels::difference_um(int upper, int lower) const {
  const Centre& high = centres_.at(index(upper));
  const Centre& low = centres_.at(index(lower));
  return high.z_um - low.z_um - slope_[0] * (high.x_um - low.x_um) - slope_[1] * (high.y_um - low.y_um);
}

double JointLevels::correlation_factor(int upper, int lower) const {
  const Centre& high = centres_.at(index(upper));
  const Centre& low = centres_.at(index(lower));
  const double dx = high.x_um - low.x_um;
  const double dy = high.y_um - low.y_um;
  // Slopes come from distances to the groups' centres, and so are independent of the means.
  const std::array<double, 2> change = slope_change(dx, dy);
  const double of_slope = dx * change[0] + dy * change[1];
  const double of_means = 1.0 / high.points + 1.0 / low.points;
  return std::sqrt(1.0 + of_slope / of_means);
}

WeightMap JointLevels::weights(const HeightField& field, const PointGroups& groups, int upper, int lower,
                               double per_difference, std::array<double, 2> per_slope) const {
  check(field, groups);
  assert(static_cast<std::size_t>(groups.count) == centres_.size());
  const Centre& high = centres_.at(index(upper));
  const Centre& low = centres_.at(index(lower));
  const std::array<double, 2> change = slope_change(per_slope[0] - per_difference * (high.x_um - low.x_um),
                                                    per_slope[1] - per_difference * (high.y_um - low.y_um));
  std::vector<double> of_mean(centres_.size(), 0.0);
  of_mean[index(upper)] += per_difference / high.points;
  of_mean[index(lower)] -= per_difference / low.points;

  WeightMap map{groups.left, groups.top, Plane<double>(groups.group.width(), groups.group.height())};
  for_each_run(groups, [&](int group, int column, int row, int count) {
    const double* z = field.z_um.row(row) + column;
    const Centre& centre = centres_[index(group)];
    const double slope = centre.decides ? change[0] : 0.0;
    const double constant =
        of_mean[index(group)] + (centre.decides ? change[1] * (field.y_um(row) - centre.y_um) : 0.0);
    double* weight = map.weights.row(row - groups.top) + column - groups.left;
    for (int i = 0; i < count; ++i) {
      weight[i] = std::isnan(z[i]) ? 0.0 : constant + slope * (field.x_um(column + i) - centre.x_um);
    }
  });
  return map;
}

}  // namespace fvd::metrology
