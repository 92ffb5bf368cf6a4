#include "core/metrology/filter/robust_rounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/metrology/filter/filter_settings.hpp"

namespace fvd::metrology {
namespace {

/// Residuals below this share of the heights are rounding.
constexpr double kExactFit = 1e-12;
/// A median below this share of the largest residual is rounding.
constexpr double kNoScale = 1e-9;
constexpr double kScaleOfLargest = 1e-3;

/// 0 where every point is fitted exactly. magnitudes: memory of the rounds.
double tukey_cut(std::span<const double> z_um, std::span<const double> smooth_um, std::vector<double>& magnitudes) {
  magnitudes.clear();
  double largest = 0.0;
  double largest_height = 0.0;
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    const double residual = std::abs(z_um[i] - smooth_um[i]);
    if (std::isnan(residual)) continue;
    magnitudes.push_back(residual);
    largest = std::max(largest, residual);
    largest_height = std::max(largest_height, std::abs(z_um[i]));
  }
  if (magnitudes.empty() || largest <= kExactFit * largest_height) return 0.0;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  double median = *middle;
  if (magnitudes.size() % 2 == 0) median = 0.5 * (median + *std::max_element(magnitudes.begin(), middle));
  const double cut = kTukeyCut * median;
  return cut > kNoScale * largest ? cut : kScaleOfLargest * largest;
}

void weigh(std::span<const double> z_um, std::span<const double> smooth_um, double cut, std::span<double> weights) {
  for (std::size_t i = 0; i < z_um.size(); ++i) {
    const double ratio = (z_um[i] - smooth_um[i]) / cut;
    if (std::isnan(ratio)) continue;
    const double rest = 1.0 - ratio * ratio;
    weights[i] = rest > 0.0 ? rest * rest : 0.0;
  }
}

}  // namespace

RobustRounds fit_robustly(std::span<const double> z_um, std::span<double> weights, std::span<const double> smooth_um,
                          const std::function<void()>& fit) {
  RobustRounds result;
  std::vector<double> magnitudes;
  magnitudes.reserve(z_um.size());
  fit();
  for (double cut = tukey_cut(z_um, smooth_um, magnitudes); cut > 0.0;) {
    if (result.rounds == kMaxRobustRounds) {
      result.converged = false;
      break;
    }
    weigh(z_um, smooth_um, cut, weights);
    fit();
    ++result.rounds;
    result.cut_um = cut;
    const double next = tukey_cut(z_um, smooth_um, magnitudes);
    if (std::abs(next - cut) < kRobustChange * cut || next == 0.0) break;
    cut = next;
  }
  return result;
}

}  // namespace fvd::metrology
