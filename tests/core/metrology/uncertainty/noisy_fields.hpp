#pragma once

/// Fields with uneven noise and holes, and kernels, for the tests of uncertainty.

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology::testing {

inline LateralKernel box(int n) { return {std::vector<double>(static_cast<std::size_t>(n), 1.0 / n)}; }

inline LateralKernel double_box(int n, int m) {
  std::vector<double> weights(static_cast<std::size_t>(n + m - 1), 0.0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(m); ++j) weights[i + j] += 1.0 / (n * m);
  }
  return {weights};
}

/// Correlation of two points d pixels apart along one axis.
inline double correlation_along(const LateralKernel& kernel, int d) {
  const auto lag = static_cast<std::size_t>(std::abs(d));
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
    squares += kernel.weights[i] * kernel.weights[i];
    if (i + lag < kernel.weights.size()) sum += kernel.weights[i] * kernel.weights[i + lag];
  }
  return sum / squares;
}

inline double uneven_sigma_um(int x, int y) { return 0.05 + 0.01 * ((3 * x + 5 * y) % 7); }

/// A tilted plane without noise, sigma uneven. Holes: a block and single points where with_holes.
inline HeightField uneven_field(int width, int height, LateralKernel kernel, bool with_holes) {
  HeightField field{Plane<double>(width, height), Plane<float>(width, height), 1.0, 1.0, std::move(kernel)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool hole = with_holes && ((x >= 5 && x < 9 && y >= 4 && y < 7) || (7 * x + 11 * y) % 23 == 0);
      field.z_um.at(x, y) = hole ? std::numeric_limits<double>::quiet_NaN() : 0.1 * x - 0.02 * y;
      field.sigma_um.at(x, y) =
          hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(uneven_sigma_um(x, y));
    }
  }
  return field;
}

}  // namespace fvd::metrology::testing
