#include "core/metrology/edge/robust.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

namespace fvd::metrology::edge {
namespace {

constexpr double kTukeyCut = 4.685;
constexpr int kAbsoluteRounds = 8;
constexpr int kRounds = 20;
// Residuals under this share of the data's range are arithmetic, not noise.
constexpr double kLeastScale = 1e-10;

}  // namespace

double quantile(std::vector<double> values, double p) {
  assert(!values.empty());
  const double place = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  const auto at = values.begin() + below;
  std::nth_element(values.begin(), at, values.end());
  const double low = *at;
  if (at + 1 == values.end()) return low;
  const double high = *std::min_element(at + 1, values.end());
  return low + (place - static_cast<double>(below)) * (high - low);
}

double robust_sd(std::vector<double> values) {
  const double centre = median(values);
  for (double& value : values) value = std::abs(value - centre);
  return kSdPerMad * median(std::move(values));
}

double Polynomial::operator()(double x) const {
  const double t = (x - centre) / half;
  double sum = 0.0;
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * t + coefficients[i];
  return sum;
}

double Polynomial::slope(double x) const {
  const double t = (x - centre) / half;
  double sum = 0.0;
  for (std::size_t i = coefficients.size(); i-- > 1;) sum = sum * t + static_cast<double>(i) * coefficients[i];
  return sum / half;
}

Polynomial robust_polynomial(std::span<const double> x, std::span<const double> y, int degree,
                             std::span<const double> weights) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const Eigen::Index terms = degree + 1;
  assert(n >= terms && y.size() == x.size() && (weights.empty() || weights.size() == x.size()));
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const auto [bottom, top] = std::minmax_element(y.begin(), y.end());
  Polynomial result{(*low + *high) / 2.0, std::max((*high - *low) / 2.0, 1e-300), {}};
  Eigen::MatrixXd design(n, terms);
  for (Eigen::Index i = 0; i < n; ++i) {
    double power = 1.0;
    for (Eigen::Index k = 0; k < terms; ++k, power *= (x[static_cast<std::size_t>(i)] - result.centre) / result.half) {
      design(i, k) = power;
    }
  }
  const Eigen::Map<const Eigen::VectorXd> values(y.data(), n);
  const Eigen::VectorXd base = weights.empty() ? Eigen::VectorXd(Eigen::VectorXd::Ones(n))
                                               : Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(weights.data(), n));
  const double least = kLeastScale * std::max(*top - *bottom, 1e-12);
  Eigen::VectorXd weight = base;
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(terms);
  for (int round = 0; round < kAbsoluteRounds + kRounds; ++round) {
    const Eigen::MatrixXd weighted = weight.asDiagonal() * design;
    const Eigen::VectorXd next = (design.transpose() * weighted).ldlt().solve(weighted.transpose() * values);
    const double change = (next - solution).cwiseAbs().maxCoeff();
    solution = next;
    const Eigen::VectorXd residual = values - design * solution;
    std::vector<double> sizes(static_cast<std::size_t>(n));
    Eigen::Map<Eigen::VectorXd>(sizes.data(), n) = residual.cwiseAbs();
    const double scale = std::max(kSdPerMad * median(std::move(sizes)), least);
    const bool absolute = round < kAbsoluteRounds;
    if (!absolute && change < 1e-4 * scale) break;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double size = std::abs(residual[i]) / scale;
      const double rest = 1.0 - std::min(1.0, std::pow(size / kTukeyCut, 2));
      weight[i] = base[i] * (absolute ? 1.0 / std::max(size, 0.3) : rest * rest);
    }
  }
  result.coefficients.assign(solution.data(), solution.data() + terms);
  return result;
}

}  // namespace fvd::metrology::edge
