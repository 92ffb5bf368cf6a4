#include "core/metrology/filter/smooth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/metrology/filter/gaussian_kernel.hpp"
#include "core/metrology/filter/separable_sum.hpp"

namespace fvd::metrology {
namespace {

/// Weights of a smaller share of the largest do not matter to a standard error, and would make kernels long.
constexpr double kLeastWeight = 1e-4;

/// Both sides, odd number, sum 1.
std::vector<double> gaussian_of(double nesting_px) {
  const SampledGaussian half = sample_gaussian(FilterMethod::kGaussian, nesting_px);
  int reach = half.reach_px();
  while (reach > 0 && half.weights[static_cast<std::size_t>(reach)] < kLeastWeight) --reach;
  std::vector<double> whole;
  double sum = 0.0;
  for (int d = -reach; d <= reach; ++d) {
    whole.push_back(half.weights[static_cast<std::size_t>(std::abs(d))]);
    sum += whole.back();
  }
  for (double& weight : whole) weight /= sum;
  return whole;
}

std::vector<double> convolved(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> result(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

double sum_of_squares(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight * weight;
  return sum;
}

std::vector<double> squared_half(const std::vector<double>& weights, double scale) {
  std::vector<double> half;
  for (std::size_t i = weights.size() / 2; i < weights.size(); ++i) half.push_back(weights[i] * weights[i] * scale);
  return half;
}

Plane<double> variances(const HeightField& field) {
  Plane<double> result(field.width(), field.height());
  const auto sigma = field.sigma_um.pixels();
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    const auto value = static_cast<double>(sigma[i]);
    if (!std::isnan(value)) result.pixels()[i] = value * value;
  }
  return result;
}

}  // namespace

void carry_noise(const HeightField& field, const FilterSettings& settings, const Plane<double>& share, WorkerPool* pool,
                 HeightField& result) {
  const bool smooth = settings.side == FilterSide::kS;
  if (!smooth && !field.has_sigma()) return;
  const std::vector<double>& window = field.kernel.weights;
  const std::vector<double> x = convolved(window, gaussian_of(settings.nesting_um / field.pitch_x_um));
  if (smooth) result.kernel.weights = x;
  if (!field.has_sigma()) return;
  Plane<double> variance = variances(field);
  if (smooth) {
    const std::vector<double> y = convolved(window, gaussian_of(settings.nesting_um / field.pitch_y_um));
    const double scale = 1.0 / sum_of_squares(window);
    variance = separable_sum(variance, {squared_half(x, scale), squared_half(y, scale), 1.0, 1.0}, pool);
  }
  result.sigma_um = Plane<float>(field.width(), field.height(), std::numeric_limits<float>::quiet_NaN());
  const auto sigma = result.sigma_um.pixels();
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    if (std::isnan(result.z_um.pixels()[i])) continue;
    const double root = std::sqrt(std::max(variance.pixels()[i], 0.0));
    sigma[i] = static_cast<float>(smooth ? root / share.pixels()[i] : root);
  }
}

}  // namespace fvd::metrology
