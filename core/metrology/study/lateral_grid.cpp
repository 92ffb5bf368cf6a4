#include "core/metrology/study/lateral_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <Eigen/Dense>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

constexpr std::size_t kFewestCrossings = 6;
constexpr double kSmallestRcond = 1e-9;  ///< below it, the crossings lie on one line
constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// Place in the image = centre + steps * (index - mean index), in pixels.
struct AffineFit {
  Eigen::Matrix2d steps = Eigen::Matrix2d::Identity();     // columns: one step of index_x, of index_y
  Eigen::Matrix2d cofactors = Eigen::Matrix2d::Zero();     // of a row of steps: covariance over the residual variance
  Eigen::Vector2d variance_px2 = Eigen::Vector2d::Zero();  // of a place, along columns and rows
  std::vector<Eigen::Vector2d> residuals_px;
};

Eigen::Vector2d place_of(const GridCrossing& crossing) { return {crossing.column, crossing.row}; }
Eigen::Vector2d index_of(const GridCrossing& crossing) {
  return {static_cast<double>(crossing.index_x), static_cast<double>(crossing.index_y)};
}

/// Nothing where the indices or the places lie on one line.
std::optional<AffineFit> fit_affine(std::span<const GridCrossing> crossings) {
  const auto n = static_cast<double>(crossings.size());
  Eigen::Vector2d mean_place = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_index = Eigen::Vector2d::Zero();
  for (const GridCrossing& crossing : crossings) {
    mean_place += place_of(crossing) / n;
    mean_index += index_of(crossing) / n;
  }
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  for (const GridCrossing& crossing : crossings) {
    const Eigen::Vector2d index = index_of(crossing) - mean_index;
    squares += index * index.transpose();
    products += (place_of(crossing) - mean_place) * index.transpose();
  }
  const auto singular = [](const Eigen::Matrix2d& matrix) {
    return !(std::abs(matrix.determinant()) > kSmallestRcond * matrix.squaredNorm());
  };
  if (singular(squares)) return std::nullopt;
  AffineFit fit;
  fit.cofactors = squares.inverse();
  fit.steps = products * fit.cofactors;
  if (singular(fit.steps)) return std::nullopt;
  for (const GridCrossing& crossing : crossings) {
    const Eigen::Vector2d residual = place_of(crossing) - mean_place - fit.steps * (index_of(crossing) - mean_index);
    fit.residuals_px.push_back(residual);
    fit.variance_px2 += residual.cwiseAbs2() / (n - 3.0);
  }
  return fit;
}

/// Standard uncertainty of a scale whose derivative to steps(i, j) is gradient(i, j).
double propagated(const AffineFit& fit, const Eigen::Matrix2d& gradient) {
  double variance = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d row = gradient.row(axis).transpose();
    variance += fit.variance_px2[axis] * row.dot(fit.cofactors * row);
  }
  return std::sqrt(variance);
}

void set_scales(LateralGrid& grid, const AffineFit& fit, double grid_pitch_um, double u_grid_relative) {
  const Eigen::Matrix2d indices = fit.steps.inverse();  // grid steps per pixel
  const Eigen::Vector2d column_um = grid_pitch_um * indices.col(0);
  const Eigen::Vector2d row_um = grid_pitch_um * indices.col(1);
  grid.pitch_x_um = column_um.norm();
  grid.pitch_y_um = (column_um.x() * row_um.y() - column_um.y() * row_um.x()) / grid.pitch_x_um;
  grid.shear = column_um.dot(row_um) / grid.pitch_x_um / grid.pitch_y_um;
  grid.angle_deg = -std::atan2(column_um.y(), column_um.x()) / kDegree;

  // With d(indices) = -indices d(steps) indices; pitch_x pitch_y = grid_pitch^2 / det(steps).
  const Eigen::Vector2d left = grid_pitch_um * indices.transpose() * column_um / grid.pitch_x_um;
  const Eigen::Matrix2d of_x = -left * indices.col(0).transpose();
  const Eigen::Matrix2d of_y = -grid.pitch_y_um * (indices.transpose() + of_x / grid.pitch_x_um);
  grid.u_pitch_x_um = std::hypot(propagated(fit, of_x), u_grid_relative * grid.pitch_x_um);
  grid.u_pitch_y_um = std::hypot(propagated(fit, of_y), u_grid_relative * grid.pitch_y_um);
}

void set_deviations(LateralGrid& grid, const AffineFit& fit) {
  double squares = 0.0;
  for (const Eigen::Vector2d& residual : fit.residuals_px) {
    const double y_um = grid.pitch_y_um * residual.y();
    const double x_um = grid.pitch_x_um * residual.x() + grid.shear * y_um;
    grid.deviations_x_um.push_back(x_um);
    grid.deviations_y_um.push_back(y_um);
    grid.deviation_max_um = std::max(grid.deviation_max_um, std::hypot(x_um, y_um));
    squares += x_um * x_um + y_um * y_um;
  }
  grid.deviation_rms_um = std::sqrt(squares / static_cast<double>(fit.residuals_px.size()));
}

StudyRefusal too_few(std::size_t crossings) {
  return {std::to_string(crossings) + " crossings, at least " + std::to_string(kFewestCrossings) + " are needed"};
}

}  // namespace

StudyOutcome<LateralGrid> lateral_grid(std::span<const GridCrossing> crossings, double grid_pitch_um,
                                       double u_grid_relative) {
  if (!(grid_pitch_um > 0.0 && std::isfinite(grid_pitch_um)) || !(u_grid_relative >= 0.0)) {
    throw Error(ErrorCode::kBadInput, "the pitch of a grid must be above 0 and its uncertainty not below 0");
  }
  if (crossings.size() < kFewestCrossings) return too_few(crossings.size());
  const std::optional<AffineFit> fit = fit_affine(crossings);
  if (!fit) return StudyRefusal{"the crossings lie on one line"};
  if (fit->steps.determinant() < 0.0) {
    return StudyRefusal{"the grid's lines are numbered as in a mirror: x to the right and y down is asked for"};
  }
  LateralGrid grid;
  set_scales(grid, *fit, grid_pitch_um, u_grid_relative);
  set_deviations(grid, *fit);
  return grid;
}

}  // namespace fvd::metrology
