#include "core/focus/fit/curve_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/focus/fit/sample_heights.hpp"
#include "core/focus/kernels/five_sample_fit.hpp"

namespace fvd {

namespace {

constexpr std::size_t kLeastLookedAt = 500;
constexpr std::size_t kLeastCurves = 20;
constexpr std::size_t kMostCurves = 4000;  // the median of so many is good to 1 %
/// Of the scan's median shoulder; spikes have less, curves of the recorded stacks and of steps up to a width have more.
constexpr double kShoulderShare = 0.48;
/// A median below this is one of spikes: theirs is 0.02, that of curves 0.9 widths from sample to sample 0.095.
constexpr double kLeastMedianShoulder = 0.06;
constexpr double kShoulderWithoutMedian = 0.1;
constexpr double kNeighboursWithoutMedian = 1.0;  // three samples above half

/// Curvature of G per sample distance squared, as fit_five finds it.
std::optional<double> bend(const CurveTuple& tuple, const HeightEntry& at, bool logarithm) {
  const std::array u{at.u_left2, at.u_left, 0.0F, at.u_right, at.u_right2};
  std::array<double, 5> s{};  // sums over the samples of w u^n, w = r^4 or, with the logarithm, r^2
  std::array<double, 3> t{};  // and of w u^n g
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (i != 2 && u[i] == 0.0F) continue;
    const double r = std::max(static_cast<double>(tuple.share[i]), static_cast<double>(kSmallestShare));
    double w = logarithm ? r * r : r * r * r * r;
    const double g = logarithm ? -std::log(r) : 1.0 / std::sqrt(r);
    for (std::size_t n = 0; n < s.size(); ++n, w *= static_cast<double>(u[i])) {
      s[n] += w;
      if (n < t.size()) t[n] += w * g;
    }
  }
  const double c20 = s[1] * s[3] - s[2] * s[2];
  const double c12 = s[1] * s[2] - s[0] * s[3];
  const double c22 = s[0] * s[2] - s[1] * s[1];
  const double determinant = s[2] * c20 + s[3] * c12 + s[4] * c22;
  const double found = (c20 * t[0] + c12 * t[1] + c22 * t[2]) / determinant;
  return determinant > 0.0 && found > 0.0 ? std::optional(found) : std::nullopt;
}

std::optional<double> shoulder(const CurveTuple& tuple, const HeightEntry& at) {
  if (at.u_left2 == 0.0F || at.u_right2 == 0.0F) return std::nullopt;
  const double near = static_cast<double>(tuple.share[1]) + static_cast<double>(tuple.share[3]);
  const double far = static_cast<double>(tuple.share[0]) + static_cast<double>(tuple.share[4]);
  return near < 2.0 ? std::optional((near - far) / (2.0 - near)) : std::nullopt;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double CurveLimits::neighbours(double scale_um) const noexcept {
  const double rise = most_bend_per_um2 * scale_um * scale_um;  // of G at the neighbours
  return std::max(least_neighbours, logarithm ? 2.0 * std::exp(-rise) : 2.0 / ((1.0 + rise) * (1.0 + rise)));
}

CurveLimits curve_limits(std::span<const CurveTuple> tuples, std::size_t looked_at, const std::vector<double>& z_um,
                         const PointTests& tests, bool logarithm) {
  CurveLimits limits;
  limits.logarithm = logarithm;
  if (looked_at < kLeastLookedAt) return limits;
  const std::vector<HeightEntry> heights = height_table(z_um);
  std::vector<double> bends_per_um2;
  std::vector<double> shoulders;
  const std::size_t count = std::min(tuples.size(), kMostCurves);
  for (std::size_t i = 0; i < count; ++i) {
    const CurveTuple& tuple = tuples[count == tuples.size() ? i : spread_index(i, tuples.size())];
    const HeightEntry& at = heights[static_cast<std::size_t>(tuple.index)];
    if (at.mask != 0) continue;
    const auto scale_um = static_cast<double>(at.scale_um);
    if (const auto found = bend(tuple, at, logarithm)) bends_per_um2.push_back(*found / (scale_um * scale_um));
    if (const auto found = shoulder(tuple, at)) shoulders.push_back(*found);
  }
  const bool known = std::min(bends_per_um2.size(), shoulders.size()) >= kLeastCurves;
  const double usual_shoulder = known ? median(shoulders) : 0.0;
  if (usual_shoulder < kLeastMedianShoulder) {
    if (tests.narrow_curve > 0.0 && z_um.size() >= 5) {
      limits.least_neighbours = kNeighboursWithoutMedian;
      limits.least_shoulder = kShoulderWithoutMedian;
    }
    return limits;
  }
  const double usual_bend_per_um2 = median(bends_per_um2);
  limits.least_bend_per_um2 = tests.broad_curve * usual_bend_per_um2;
  if (tests.narrow_curve > 0.0) {
    limits.most_bend_per_um2 = usual_bend_per_um2 / (tests.narrow_curve * tests.narrow_curve);
    limits.least_shoulder = kShoulderShare * usual_shoulder;
  }
  return limits;
}

}  // namespace fvd
