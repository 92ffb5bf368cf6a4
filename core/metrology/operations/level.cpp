#include "core/metrology/operations/level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Dense>

#include "core/metrology/operations/chosen_points.hpp"
#include "core/metrology/operations/plane_sums.hpp"
#include "core/metrology/operations/plane_values.hpp"
#include "core/metrology/operations/robust_plane.hpp"

namespace fvd::metrology {
namespace {

constexpr double kSmallestRcond = 1e-12;  ///< below it, the points lie on one line

struct Fit {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// share: of a point in the matrix and the vector. The second round removes the rounding of the first.
/// known_scale: the weights are 1 / variance, so that the scatter only enlarges what they say.
template <typename Share>
std::optional<Fit> fit_linear(const ChosenPoints& points, bool known_scale, WorkerPool* pool, const Share& share) {
  Fit fit;
  PlaneSums sums;
  for (int round = 0; round < 2; ++round) {
    sums = sum_plane(points, fit.plane, pool, share);
    const Eigen::LLT<Eigen::Matrix3d> solver(sums.matrix);
    if (solver.info() != Eigen::Success || !(solver.rcond() > kSmallestRcond)) return std::nullopt;
    fit.plane += solver.solve(sums.vector);
  }
  const double freedom = static_cast<double>(points.points) - 3.0;
  const double scatter = freedom > 0.0 ? std::max(sums.squares, 0.0) / freedom : 0.0;
  fit.covariance = sums.matrix.inverse() * (known_scale ? std::max(1.0, scatter) : scatter);
  return fit;
}

std::optional<Fit> fit_least_squares(const ChosenPoints& points, WorkerPool* pool) {
  return fit_linear(points, false, pool, [](int, std::size_t, double r) { return PointShare{1.0, r}; });
}

std::optional<Fit> fit_weighted(const ChosenPoints& points, WorkerPool* pool) {
  const Plane<float>& sigma = points.sigma_um;
  return fit_linear(points, true, pool, [&sigma](int row, std::size_t column, double r) {
    const double here = static_cast<double>(sigma.row(row)[column]);
    const double weight = 1.0 / (here * here);
    return PointShare{weight, weight * r};
  });
}

/// A standard error of 0 would outweigh every other point: those points are left out.
std::size_t drop_without_sigma(ChosenPoints& points) {
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < points.z_um.pixels().size(); ++i) {
    double& z = points.z_um.pixels()[i];
    if (std::isnan(z) || points.sigma_um.pixels()[i] > 0.0F) continue;
    z = std::numeric_limits<double>::quiet_NaN();
    ++dropped;
  }
  points.points -= dropped;
  return dropped;
}

std::optional<Fit> fit_robust(const ChosenPoints& points, OperationReport& report, WorkerPool* pool) {
  const std::optional<RobustPlane> robust = fit_robust_plane(points, pool);
  if (!robust) return std::nullopt;
  report.values = {{"cut_um", robust->cut_um, std::nullopt},
                   {"rounds", static_cast<double>(robust->rounds), std::nullopt},
                   {"share_without_weight", robust->share_without_weight, std::nullopt}};
  if (robust->last_change_um > 1e-4 * robust->cut_um) {
    report.warnings.emplace_back("the robust plane has not settled: it still moves by " +
                                 std::to_string(robust->last_change_um) + " um");
  }
  return Fit{robust->plane, robust->covariance};
}

}  // namespace

OperationReport level(HeightField& field, LevelMethod method, const Region& region, WorkerPool* pool) {
  const bool weighted = method == LevelMethod::kWeighted;
  if (weighted && !field.has_sigma()) return refusal("the surface has no standard errors to weigh its points by");
  ChosenPoints points = choose_points(field, region, weighted, pool);
  OperationReport report;
  if (weighted) {
    const std::size_t dropped = drop_without_sigma(points);
    if (dropped > 0) {
      report.warnings.emplace_back(std::to_string(dropped) +
                                   " points with a standard error of 0 were left out of the fit");
    }
  }
  report.points_used = points.points;
  std::optional<Fit> fit;
  if (points.points >= 3) {
    fit = weighted                         ? fit_weighted(points, pool)
          : method == LevelMethod::kRobust ? fit_robust(points, report, pool)
                                           : fit_least_squares(points, pool);
  }
  if (!fit) return refusal("a plane needs three points of the region that do not lie on one line");
  put_plane_first(report, points, fit->plane, fit->covariance, field.kernel.width_px());
  subtract_plane(field, points, fit->plane, pool);
  return report;
}

}  // namespace fvd::metrology
