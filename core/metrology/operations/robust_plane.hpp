#pragma once

/// A plane through the majority of points.

#include <optional>

#include <Eigen/Core>

#include "core/metrology/operations/chosen_points.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

struct RobustPlane {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();  ///< height at the middle, rise to the block's border along x and y
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< as if the errors of all points were independent
  double cut_um = 0.0;
  int rounds = 0;
  double last_change_um = 0.0;  ///< largest change within the block in the last round
  double share_without_weight = 0.0;
};

/// As level() describes. Absent where the points do not span a plane. context: pure.
[[nodiscard]] std::optional<RobustPlane> fit_robust_plane(const ChosenPoints& points, WorkerPool* pool);

}  // namespace fvd::metrology
