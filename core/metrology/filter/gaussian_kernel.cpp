#include "core/metrology/filter/gaussian_kernel.hpp"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace fvd::metrology {
namespace {

constexpr double kMeanWidth = 0.46971863934982567;        // sqrt(ln 2 / pi)
constexpr double kParaboloidWidth = 0.73091342809467587;  // sqrt(u / pi), (1 + u) exp(-u) = 1 / 2, u = 1.678347

}  // namespace

double gaussian_width(FilterMethod method) noexcept {
  return method == FilterMethod::kGaussianRegression2 ? kParaboloidWidth : kMeanWidth;
}

double gaussian_deviation(FilterMethod method, double nesting) noexcept {
  return gaussian_width(method) * nesting / std::sqrt(2.0 * std::numbers::pi);
}

double filter_transmission(FilterMethod method, double nesting_over_wavelength) noexcept {
  const double ratio = gaussian_width(method) * nesting_over_wavelength;
  const double u = std::numbers::pi * ratio * ratio;
  return method == FilterMethod::kGaussianRegression2 ? (1.0 + u) * std::exp(-u) : std::exp(-u);
}

double SampledGaussian::sum() const {
  double tail = 0.0;
  for (std::size_t i = weights.size(); i-- > 1;) tail += weights[i];
  return weights.front() + 2.0 * tail;
}

SampledGaussian sample_gaussian(FilterMethod method, double nesting_px, double support) {
  assert(nesting_px > 0.0 && support >= 0.75);
  const double support_px = support * nesting_px * gaussian_width(method) / kMeanWidth;
  SampledGaussian kernel;
  kernel.deviation_px = gaussian_deviation(method, nesting_px);
  const auto reach = static_cast<std::size_t>(std::ceil(support_px));
  kernel.weights.reserve(reach + 1);
  for (std::size_t i = 0; i <= reach; ++i) {
    const double distance = static_cast<double>(i) / kernel.deviation_px;
    kernel.weights.push_back(std::exp(-0.5 * distance * distance));
  }
  return kernel;
}

}  // namespace fvd::metrology
