#include "core/metrology/profile/profile_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fvd::metrology {
namespace {

/// Weights of z(+k) - z(-k) for k = 1, 2, 3, in units of one pitch; the more neighbours, the higher the order.
constexpr std::array<std::array<double, 3>, 3> kDifferences{{
    {1.0 / 2.0, 0.0, 0.0},
    {8.0 / 12.0, -1.0 / 12.0, 0.0},
    {45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0},
}};

/// Neighbours on both sides without a hole, three at most; 0 for a hole.
std::size_t reach_at(std::span<const double> z, std::size_t i) {
  if (std::isnan(z[i])) return 0;
  std::size_t reach = 0;
  while (reach < 3 && i > reach && i + reach + 1 < z.size() && !std::isnan(z[i - reach - 1]) &&
         !std::isnan(z[i + reach + 1])) {
    ++reach;
  }
  return reach;
}

}  // namespace

HeightSums sum_heights(std::span<const double> z_um) {
  HeightSums sums;
  double squares = 0.0;
  double cubes = 0.0;
  double fourths = 0.0;
  for (const double z : z_um) {
    if (std::isnan(z)) continue;
    sums.highest_um = sums.points == 0 ? z : std::max(sums.highest_um, z);
    sums.deepest_um = sums.points == 0 ? -z : std::max(sums.deepest_um, -z);
    ++sums.points;
    sums.mean_absolute_um += std::abs(z);
    squares += z * z;
    cubes += z * z * z;
    fourths += z * z * z * z;
  }
  if (sums.points == 0) return sums;
  const auto n = static_cast<double>(sums.points);
  sums.mean_absolute_um /= n;
  const double variance = squares / n;
  sums.root_mean_square_um = std::sqrt(variance);
  if (variance > 0.0) {
    sums.cubes = cubes / n / (variance * sums.root_mean_square_um);
    sums.fourths = fourths / n / (variance * variance);
  }
  return sums;
}

std::size_t longest_hole(std::span<const double> z_um) {
  std::size_t longest = 0;
  std::size_t run = 0;
  for (const double z : z_um) {
    run = std::isnan(z) ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

std::vector<double> less_line(std::span<const double> z_um) {
  double n = 0.0;
  double mean_x = 0.0;
  double mean_z = 0.0;
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    if (std::isnan(z_um[i])) continue;
    n += 1.0;
    mean_x += static_cast<double>(i);
    mean_z += z_um[i];
  }
  std::vector<double> result(z_um.begin(), z_um.end());
  if (n == 0.0) return result;
  mean_x /= n;
  mean_z /= n;
  double xx = 0.0;
  double xz = 0.0;
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    if (std::isnan(z_um[i])) continue;
    const double x = static_cast<double>(i) - mean_x;
    xx += x * x;
    xz += x * (z_um[i] - mean_z);
  }
  const double slope = xx > 0.0 ? xz / xx : 0.0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] -= mean_z + slope * (static_cast<double>(i) - mean_x);
  }
  return result;
}

std::vector<double> less_mean(std::span<const double> z_um) {
  std::vector<double> result(z_um.begin(), z_um.end());
  double sum = 0.0;
  double n = 0.0;
  for (const double z : z_um) {
    if (std::isnan(z)) continue;
    sum += z;
    n += 1.0;
  }
  if (n == 0.0) return result;
  for (double& z : result) z -= sum / n;
  return result;
}

std::optional<double> root_mean_square_slope(std::span<const double> z_um, double pitch_um) {
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    const std::size_t reach = reach_at(z_um, i);
    if (reach == 0) continue;
    double slope = 0.0;
    for (std::size_t k = 1; k <= reach; ++k) slope += kDifferences[reach - 1][k - 1] * (z_um[i + k] - z_um[i - k]);
    slope /= pitch_um;
    squares += slope * slope;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(count));
}

}  // namespace fvd::metrology
