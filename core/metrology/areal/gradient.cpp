#include "core/metrology/areal/gradient.hpp"

#include <cmath>
#include <cstddef>

namespace fvd::metrology {
namespace {

/// The slope at z by its neighbours at the given stride, times the pitch; NaN where a neighbour next to it is missing.
double central_difference(const double* z, std::ptrdiff_t stride) {
  const double first = z[stride] - z[-stride];
  const double second = z[2 * stride] - z[-2 * stride];
  const double third = z[3 * stride] - z[-3 * stride];
  const double order4 = (8.0 * first - second) / 12.0;
  const double order6 = (45.0 * first - 9.0 * second + third) / 60.0;
  const double narrow = std::isnan(order4) ? 0.5 * first : order4;
  return std::isnan(order6) ? narrow : order6;
}

/// sqrt(1 + square) - 1 without losing the digits of small slopes.
double stretch(double square) { return square / (1.0 + std::sqrt(1.0 + square)); }

struct Sum {
  double total = 0.0;
  double count = 0.0;

  void add(double value) {
    const bool valid = !std::isnan(value);
    total += valid ? value : 0.0;
    count += valid ? 1.0 : 0.0;
  }
  void add(const Sum& row) {
    total += row.total;
    count += row.count;
  }
  [[nodiscard]] std::optional<double> mean() const {
    return count > 0.0 ? std::optional<double>(total / count) : std::nullopt;
  }
};

}  // namespace

std::optional<double> root_mean_square_gradient(const RegionHeights& heights) {
  const std::ptrdiff_t stride = heights.z_um.width();
  Sum sum;
  for (int y = 0; y < heights.height; ++y) {
    const double* z = heights.row(y);
    Sum row;
    for (int x = 0; x < heights.width; ++x) {
      const double slope_x = central_difference(z + x, 1) / heights.pitch_x_um;
      const double slope_y = central_difference(z + x, stride) / heights.pitch_y_um;
      row.add(std::isnan(z[x]) ? z[x] : slope_x * slope_x + slope_y * slope_y);
    }
    sum.add(row);
  }
  const std::optional<double> mean_square = sum.mean();
  return mean_square ? std::optional<double>(std::sqrt(*mean_square)) : std::nullopt;
}

std::optional<double> developed_area_ratio_percent(const RegionHeights& heights) {
  const double per_x_um = 1.0 / heights.pitch_x_um;
  const double per_y_um = 1.0 / heights.pitch_y_um;
  Sum sum;
  for (int y = 0; y + 1 < heights.height; ++y) {
    const double* upper = heights.row(y);
    const double* lower = heights.row(y + 1);
    Sum row;
    for (int x = 0; x + 1 < heights.width; ++x) {
      const auto square = [](double slope) { return slope * slope; };
      const double top = square((upper[x + 1] - upper[x]) * per_x_um);
      const double bottom = square((lower[x + 1] - lower[x]) * per_x_um);
      const double left = square((lower[x] - upper[x]) * per_y_um);
      const double right = square((lower[x + 1] - upper[x + 1]) * per_y_um);
      // Each triangle has one horizontal and one vertical side; both cuts together have each such pair once.
      row.add(0.25 *
              ((stretch(top + right) + stretch(bottom + left)) + (stretch(top + left) + stretch(bottom + right))));
    }
    sum.add(row);
  }
  const std::optional<double> mean = sum.mean();
  return mean ? std::optional<double>(100.0 * *mean) : std::nullopt;
}

}  // namespace fvd::metrology
