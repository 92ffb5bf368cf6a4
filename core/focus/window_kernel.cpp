#include "core/focus/window_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fvd {
namespace {

// Of the variance that the operator's pixels have: neighbours' brightness is alike, so that the outer ones tell less of
// themselves than independent ones would. Measured: 0.52 px2 on rounded edges where the pixels say 0.75.
constexpr double kOfTexture = 2.0 / 3.0;

// Where the brightness comes from that an operator sees, by its own weights squared. An own definition.
double operator_variance_px2(const FocusSettings& settings) {
  const double outer = settings.distance_px * settings.distance_px;
  const double inner = std::pow(std::max(1, settings.distance_px / 2), 2);
  switch (settings.focus_operator) {
    case FocusOperator::kModifiedLaplacian:
      return outer / 6.0;  // a third of the energy of one of two differences is `distance` off
    case FocusOperator::kDiagonalLaplacian:
      return (4.0 * outer + 2.0 * inner) / 24.0;  // axes count twice, their other one not at all
    case FocusOperator::kTenengrad:
      return outer * (1.0 + 1.0 / 3.0) / 2.0;  // weights 1, 2, 1 across, squared
    case FocusOperator::kIntensity:
      return 0.0;
  }
  return 0.0;
}

}  // namespace

LateralKernel window_kernel(const FocusSettings& settings) {
  const WindowSides sides = window_sides(settings);
  const double weight = 1.0 / (static_cast<double>(sides.first) * sides.second);
  std::vector<double> weights(static_cast<std::size_t>(sides.first + sides.second - 1), 0.0);
  for (int i = 0; i < sides.first; ++i) {
    for (int j = 0; j < sides.second; ++j) weights[static_cast<std::size_t>(i + j)] += weight;
  }
  return {weights, kOfTexture * operator_variance_px2(settings)};
}

}  // namespace fvd
