#pragma once

/// Where a robust plane fit begins.

#include <optional>

#include <Eigen/Core>

#include "core/metrology/operations/chosen_points.hpp"

namespace fvd::metrology {

struct RobustStart {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  double median_um = 0.0;  ///< of the absolute residuals of the points looked at
};

/// Takes up to 4096 points by a fixed rule, tries planes through three of them, keeps the one with the smallest median
/// of absolute residuals (least median of squares, Rousseeuw 1984) and refines it with Tukey weights on these points.
/// Absent where the points lie on one line. context: pure.
[[nodiscard]] std::optional<RobustStart> robust_start(const ChosenPoints& points);

}  // namespace fvd::metrology
