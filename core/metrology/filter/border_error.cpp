#include "core/metrology/filter/border_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <boost/math/special_functions/erf.hpp>

#include "core/metrology/filter/gaussian_kernel.hpp"

namespace fvd::metrology {
namespace {

constexpr int kMostRowsOrColumns = 400;  // enough for a general shape

/// Half of the extent, or 1 um for a single row or column, whose coordinate is 0.
double half_extent_um(int points, double pitch_um) { return points > 1 ? 0.5 * points * pitch_um : 1.0; }

using Coefficients = Eigen::Matrix<double, 6, 1>;

Eigen::Matrix<double, 6, 1> terms(double u, double v) {
  Eigen::Matrix<double, 6, 1> result;
  result << 1.0, u, v, u * u, u * v, v * v;
  return result;
}

/// In coordinates from -1 to 1 over the field. Coefficients that the points do not determine are 0 or small.
Coefficients fit_paraboloid(const Plane<double>& z_um) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Coefficients right = Coefficients::Zero();
  const int step_x = 1 + (z_um.width() - 1) / kMostRowsOrColumns;
  const int step_y = 1 + (z_um.height() - 1) / kMostRowsOrColumns;
  for (int y = 0; y < z_um.height(); y += step_y) {
    for (int x = 0; x < z_um.width(); x += step_x) {
      const double z = z_um.at(x, y);
      if (std::isnan(z)) continue;
      const Coefficients row = terms((2.0 * x + 1.0) / z_um.width() - 1.0, (2.0 * y + 1.0) / z_um.height() - 1.0);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
      right += z * row;
    }
  }
  const Eigen::Matrix<double, 6, 6> whole = normal.selfadjointView<Eigen::Lower>();
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, 6, 6>> decomposition;
  decomposition.setThreshold(1e-9);
  decomposition.compute(whole);
  return decomposition.solve(right);
}

}  // namespace

GeneralShape general_shape(const Plane<double>& z_um, double pitch_x_um, double pitch_y_um) {
  const Coefficients c = fit_paraboloid(z_um);
  const double half_x = half_extent_um(z_um.width(), pitch_x_um);
  const double half_y = half_extent_um(z_um.height(), pitch_y_um);
  GeneralShape shape;
  // The length of a linear gradient is largest in a corner.
  for (const double u : {-1.0, 1.0}) {
    for (const double v : {-1.0, 1.0}) {
      const double end_u = z_um.width() > 1 ? u : 0.0;
      const double end_v = z_um.height() > 1 ? v : 0.0;
      shape.slope = std::max(shape.slope, std::hypot((c[1] + 2.0 * c[3] * end_u + c[4] * end_v) / half_x,
                                                     (c[2] + c[4] * end_u + 2.0 * c[5] * end_v) / half_y));
    }
  }
  const double xx = 2.0 * c[3] / (half_x * half_x);
  const double yy = 2.0 * c[5] / (half_y * half_y);
  const double xy = c[4] / (half_x * half_y);
  shape.curvature_per_um = 0.5 * std::abs(xx + yy) + std::hypot(0.5 * (xx - yy), xy);
  return shape;
}

double border_error_um(FilterMethod method, double nesting_um, const GeneralShape& shape, double smallest_share) {
  const double deviation_um = gaussian_deviation(method, nesting_um);
  switch (method) {
    case FilterMethod::kGaussian: {
      // Of all ways to lose this weight, losing it beyond a straight line moves the mean most.
      if (smallest_share >= 1.0 || smallest_share <= 0.0) return 0.0;
      const double quantile = -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * smallest_share);
      const double density = std::exp(-0.5 * quantile * quantile) / std::sqrt(2.0 * std::numbers::pi);
      return shape.slope * deviation_um * density / smallest_share;
    }
    case FilterMethod::kGaussianRegression1: {
      constexpr double kCut = (4.0 / std::numbers::pi - 1.0) / (1.0 - 2.0 / std::numbers::pi);
      return 0.5 * shape.curvature_per_um * deviation_um * deviation_um * kCut;
    }
    case FilterMethod::kGaussianRegression2:
      return 0.0;
  }
  return 0.0;
}

}  // namespace fvd::metrology
