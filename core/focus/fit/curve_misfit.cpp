#include "core/focus/fit/curve_misfit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/focus/fit/sample_heights.hpp"

namespace fvd {

namespace {

constexpr std::size_t kLeastCurves = 100;
constexpr double kLeastShare = 0.02;  // of the peak: a smaller sample tells of the floor
/// A curve with two peaks, or beside an edge, is not what curves have in common: no more than so many medians count.
constexpr double kMostMedians = 10.0;

struct Skew {
  double vertex = 0.0;  // in samples from the peak's
  double value = 0.0;
};

/// What a curve has of a cubic about its vertex, beside the parabola that is fitted to G = F^(-1/p): that moves the
/// vertex, and symmetric curves have none of it in the mean, whatever their shape. With noise of one size n on every
/// share r, G = r^(-1/p) has the variance (n / p)^2 r^(-2/p - 2); weighted with the inverse of that and divided by its
/// own size, the cubic has a coefficient of variance (n / p)^2. Returned times p.
std::optional<Skew> skew(const CurveTuple& tuple, const HeightEntry& at, double p) {
  const std::array u{at.u_left2, at.u_left, 0.0F, at.u_right, at.u_right2};
  std::array<double, 5> g{};
  std::array<double, 5> weight{};
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  const auto terms_at = [&](std::size_t i) {
    const auto place = static_cast<double>(u[i]);
    return Eigen::Vector3d(1.0, place, place * place);
  };
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto r = static_cast<double>(tuple.share[i]);
    if (at.mask != 0 || (i != 2 && u[i] == 0.0F) || !(r > kLeastShare)) return std::nullopt;
    g[i] = std::pow(r, -1.0 / p);
    weight[i] = std::pow(r, 2.0 + 2.0 / p);
    normal += weight[i] * terms_at(i) * terms_at(i).transpose();
    sums += weight[i] * g[i] * terms_at(i);
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(normal);
  const Eigen::Vector3d fit = factor.solve(sums);
  if (factor.info() != Eigen::Success || !(p * fit(2) > 0.0)) return std::nullopt;
  const double vertex = -fit(1) / (2.0 * fit(2));
  const auto cubic = [&](std::size_t i) { return std::pow(static_cast<double>(u[i]) - vertex, 3); };
  Eigen::Vector3d cubic_sums = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < u.size(); ++i) cubic_sums += weight[i] * cubic(i) * terms_at(i);
  const Eigen::Vector3d cubic_fit = factor.solve(cubic_sums);
  double product = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double rest = cubic(i) - cubic_fit.dot(terms_at(i));
    product += weight[i] * rest * g[i];
    size += weight[i] * rest * rest;
  }
  const double value = p * product / std::sqrt(size);
  return std::isfinite(value) ? std::optional(Skew{vertex, value}) : std::nullopt;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Less what all curves have: a lens that is not symmetric moves every height alike, and what a curve has of a fourth
/// power shows as a cubic where its vertex lies beside the peak's sample, which is taken off the heights.
std::vector<double> squares_about_line(const std::vector<Skew>& skews) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sums = Eigen::Vector2d::Zero();
  for (const Skew& skew : skews) {
    const Eigen::Vector2d terms(1.0, skew.vertex);
    normal += terms * terms.transpose();
    sums += skew.value * terms;
  }
  normal(1, 1) += 1e-3 * normal(0, 0);  // vertices that all lie in one place have no slope
  const Eigen::Vector2d line = normal.llt().solve(sums);
  std::vector<double> squares;
  squares.reserve(skews.size());
  for (const Skew& skew : skews) {
    const double rest = skew.value - line(0) - line(1) * skew.vertex;
    squares.push_back(rest * rest);
  }
  return squares;
}

}  // namespace

double curve_misfit(std::span<const CurveTuple> tuples, const std::vector<double>& z_um, double exponent) {
  const std::vector<HeightEntry> heights = height_table(z_um);
  std::vector<Skew> skews;
  double noise = 0.0;
  for (const CurveTuple& tuple : tuples) {
    const auto value = skew(tuple, heights[static_cast<std::size_t>(tuple.index)], exponent);
    if (!value) continue;
    skews.push_back(*value);
    noise += static_cast<double>(tuple.noise) * static_cast<double>(tuple.noise);
  }
  if (skews.size() < kLeastCurves) return 0.0;
  std::vector<double> squares = squares_about_line(skews);
  const double most = kMostMedians * median(squares);
  double sum = 0.0;
  for (const double square : squares) sum += std::min(square, most);
  return std::sqrt(std::max(0.0, (sum - noise) / static_cast<double>(skews.size())));
}

}  // namespace fvd
