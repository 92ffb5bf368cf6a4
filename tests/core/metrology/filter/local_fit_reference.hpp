#pragma once

/// Local polynomial fits in long double from their definition: every neighbour, normal equations, full elimination.

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/image/image.hpp"

namespace fvd::metrology {

/// Value at (column, row) of the polynomial of this order (0, 1 or 2) fitted to the points of z_um that are not NaN,
/// each with its weight in weights (empty: 1) times a Gaussian whose deviations are given in pixels.
inline double local_fit(const Plane<double>& z_um, const Plane<double>& weights, int column, int row, int order,
                        double deviation_x_px, double deviation_y_px) {
  const std::size_t terms = order == 0 ? 1 : (order == 1 ? 3 : 6);
  std::vector<std::vector<long double>> a(terms, std::vector<long double>(terms + 1, 0.0L));
  for (int y = 0; y < z_um.height(); ++y) {
    for (int x = 0; x < z_um.width(); ++x) {
      if (std::isnan(z_um.at(x, y))) continue;
      const long double u = (x - column) / static_cast<long double>(deviation_x_px);
      const long double v = (y - row) / static_cast<long double>(deviation_y_px);
      long double weight = std::exp(-0.5L * (u * u + v * v));
      if (!weights.empty()) weight *= static_cast<long double>(weights.at(x, y));
      const long double basis[6] = {1.0L, u, v, u * u, u * v, v * v};
      for (std::size_t i = 0; i < terms; ++i) {
        for (std::size_t j = 0; j <= i; ++j) a[i][j] += weight * basis[i] * basis[j];
        a[i][terms] += weight * basis[i] * static_cast<long double>(z_um.at(x, y));
      }
    }
  }
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = i + 1; j < terms; ++j) a[i][j] = a[j][i];
  }
  // Gauss and Jordan with exchange of rows.
  for (std::size_t k = 0; k < terms; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < terms; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[best][k])) best = i;
    }
    std::swap(a[k], a[best]);
    for (std::size_t i = 0; i < terms; ++i) {
      if (i == k) continue;
      const long double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j <= terms; ++j) a[i][j] -= factor * a[k][j];
    }
  }
  return static_cast<double>(a[0][terms] / a[0][0]);
}

/// sqrt(ln 2 / (2 pi^2)) nesting indices; for order 2 the Gaussian whose (1 + u) exp(-u) is 1/2 at the nesting index.
inline double reference_deviation(int order, double nesting) {
  const double u = order == 2 ? 1.67834699001666065 : std::numbers::ln2;
  return nesting * std::sqrt(u / 2.0) / std::numbers::pi;
}

}  // namespace fvd::metrology
