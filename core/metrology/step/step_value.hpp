#pragma once

/// From a fit of levels to a height with its weights and noise.

#include "core/metrology/step/joint_levels.hpp"
#include "core/metrology/step/step_height.hpp"

namespace fvd::metrology {

/// The height of group `upper` above group `lower`, perpendicular to the common plane: d = v / sqrt(1 + a^2 + b^2),
/// with the derivatives of that. sign: 1, or -1 to turn it round. Own definition. context: pure.
[[nodiscard]] StepValue step_value(const HeightField& field, const PointGroups& groups, const JointLevels& levels,
                                   int upper, int lower, double sign = 1.0);

}  // namespace fvd::metrology
