#pragma once

/// A fitted plane: its values for people, and its subtraction.

#include <Eigen/Core>

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/chosen_points.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// plane: height at the middle of the block and rise to its border along x and y; covariance as if the errors of all
/// points were independent, which kernel_width_px enlarges to that of errors shared by neighbours. Puts offset_um (at
/// x = y = 0), slope_x and slope_y before the values that the report has. context: pure.
void put_plane_first(OperationReport& report, const ChosenPoints& points, const Eigen::Vector3d& plane,
                     const Eigen::Matrix3d& covariance, double kernel_width_px);

/// Subtracts it from every point of the field. context: pure.
void subtract_plane(HeightField& field, const ChosenPoints& points, const Eigen::Vector3d& plane, WorkerPool* pool);

}  // namespace fvd::metrology
