#include "core/focus/lateral_period.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fvd {

namespace {

/// What the operator's neighbours add to the spread of the window's weights: a variance of so many squared distances.
double operator_spread(FocusOperator op) noexcept {
  switch (op) {
    case FocusOperator::kModifiedLaplacian:
    case FocusOperator::kDiagonalLaplacian:
      return 0.15;
    case FocusOperator::kTenengrad:
      return 0.72;
    case FocusOperator::kIntensity:
      break;
  }
  return 0.0;
}

double box_transfer(int side_px, double frequency) noexcept {
  const double angle = std::numbers::pi * frequency;
  return std::sin(side_px * angle) / (side_px * std::sin(angle));
}

}  // namespace

double lateral_period_px(const FocusSettings& settings, std::optional<double> smooth_px) noexcept {
  constexpr double kHalf = 0.5;
  const WindowSides sides = window_sides(settings);
  const double spread_px2 = operator_spread(settings.focus_operator) * settings.distance_px * settings.distance_px;
  const auto transfer = [&](double frequency) {
    const double square = 2.0 * std::numbers::pi * std::numbers::pi * frequency * frequency;
    double value =
        box_transfer(sides.first, frequency) * box_transfer(sides.second, frequency) * std::exp(-square * spread_px2);
    if (smooth_px) value *= (1.0 + square * *smooth_px * *smooth_px) * std::exp(-square * *smooth_px * *smooth_px);
    return value;
  };
  // The transfer falls from 1 until the widest box has its first zero.
  double low = 1e-6;
  double high = std::min(kHalf, 1.0 / sides.first);
  if (transfer(high) > kHalf) return 1.0 / high;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (transfer(middle) > kHalf ? low : high) = middle;
  }
  return 2.0 / (low + high);
}

}  // namespace fvd
