#pragma once

/// The sums of a plane fit over many points, in lanes that the compiler turns into vector code.

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/metrology/operations/bands.hpp"
#include "core/metrology/operations/chosen_points.hpp"

namespace fvd::metrology {

/// What one point adds: h * (1, x, y)^T (1, x, y) to the matrix, g * (1, x, y) to the vector.
struct PointShare {
  double h = 0.0;
  double g = 0.0;
};

/// matrix = sum of h * u u^T, vector = sum of g * u with u = (1, x, y) in normal coordinates; squares = sum of g * r.
struct PlaneSums {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double squares = 0.0;
};

namespace plane_sums {

inline constexpr std::size_t kLanes = 8;
using Lanes = std::array<double, kLanes>;

/// Sums of one row: h, h x, h x^2, g, g x, g r.
struct RowSums {
  Lanes h{}, hx{}, hxx{}, g{}, gx{}, gr{};

  void add(std::size_t lane, double x, double residual, PointShare share) {
    const bool valid = residual == residual;
    const double h_here = valid ? share.h : 0.0;
    const double g_here = valid ? share.g : 0.0;
    h[lane] += h_here;
    hx[lane] += h_here * x;
    hxx[lane] += h_here * x * x;
    g[lane] += g_here;
    gx[lane] += g_here * x;
    gr[lane] += g_here * (valid ? residual : 0.0);
  }
};

[[nodiscard]] inline double total(const Lanes& lanes) {
  // In pairs from outside to inside, so that a mirrored row has the same sum to a few roundings.
  return ((lanes[0] + lanes[7]) + (lanes[1] + lanes[6])) + ((lanes[2] + lanes[5]) + (lanes[3] + lanes[4]));
}

inline void add_row(PlaneSums& sums, const RowSums& row, double y) {
  const double h = total(row.h);
  const double hx = total(row.hx);
  const double g = total(row.g);
  sums.matrix(0, 0) += h;
  sums.matrix(0, 1) += hx;
  sums.matrix(0, 2) += h * y;
  sums.matrix(1, 1) += total(row.hxx);
  sums.matrix(1, 2) += hx * y;
  sums.matrix(2, 2) += h * y * y;
  sums.vector += Eigen::Vector3d(g, total(row.gx), g * y);
  sums.squares += total(row.gr);
}

}  // namespace plane_sums

/// share(row, column, residual) -> PointShare, called for holes too (residual NaN), whose result is not used.
/// plane: height at the middle and rise to the block's border along x and y.
template <typename Share>
[[nodiscard]] PlaneSums sum_plane(const ChosenPoints& points, const Eigen::Vector3d& plane, WorkerPool* pool,
                                  const Share& share) {
  const int rows = points.z_um.height();
  std::vector<PlaneSums> bands(static_cast<std::size_t>(band_count(rows)));
  run_bands(pool, rows, [&](int band, int first, int end) {
    const auto columns = static_cast<std::size_t>(points.z_um.width());
    for (int row = first; row < end; ++row) {
      const double y = points.y[static_cast<std::size_t>(row)];
      const double base = plane[0] + plane[2] * y;
      const double rise = plane[1];
      const double* z = points.z_um.row(row);
      const double* x = points.x.data();
      plane_sums::RowSums sums;
      std::size_t i = 0;
      for (; i + plane_sums::kLanes <= columns; i += plane_sums::kLanes) {
        for (std::size_t lane = 0; lane < plane_sums::kLanes; ++lane) {
          const double residual = z[i + lane] - (base + rise * x[i + lane]);
          sums.add(lane, x[i + lane], residual, share(row, i + lane, residual));
        }
      }
      for (; i < columns; ++i) {
        const double residual = z[i] - (base + rise * x[i]);
        sums.add(0, x[i], residual, share(row, i, residual));
      }
      plane_sums::add_row(bands[static_cast<std::size_t>(band)], sums, y);
    }
  });
  PlaneSums total;
  for (const PlaneSums& band : bands) {
    total.matrix += band.matrix;
    total.vector += band.vector;
    total.squares += band.squares;
  }
  total.matrix.triangularView<Eigen::StrictlyLower>() = total.matrix.transpose();
  return total;
}

}  // namespace fvd::metrology
