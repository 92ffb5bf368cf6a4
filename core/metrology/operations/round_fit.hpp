#pragma once

/// Orthogonal distance fits of spheres, cylinders and cones.

#include <optional>

#include <Eigen/Core>

#include "core/metrology/operations/chosen_points.hpp"
#include "core/metrology/operations/round_form.hpp"

namespace fvd::metrology {

struct RoundFit {
  RoundForm form;
  Eigen::MatrixXd covariance;  ///< of the step of RoundForm::moved(), as if errors were independent
  double rms_um = 0.0;         ///< of the distances
};

/// Levenberg and Marquardt's method: from each start on a coarse choice of points, from the best of these on all.
/// Absent where the points do not determine the form or the fit has not settled after 60 rounds. context: pure.
template <RoundKind kKind>
[[nodiscard]] std::optional<RoundFit> fit_round(const ChosenPoints& points);

}  // namespace fvd::metrology
