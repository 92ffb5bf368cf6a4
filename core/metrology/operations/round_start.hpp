#pragma once

/// First guesses of spheres, cylinders and cones.

#include <vector>

#include "core/metrology/operations/chosen_points.hpp"
#include "core/metrology/operations/round_form.hpp"

namespace fvd::metrology {

/// Points to look at: every `step` rows and columns, so that there are at most some 20 000.
[[nodiscard]] int coarse_step(const ChosenPoints& points);

/// From the tangent plane and the curvatures of a paraboloid through the points (least squares along z), for a cylinder
/// both ways round; for a cone also one that stands upright. One of them leads the fit home. Empty where the points do
/// not determine a paraboloid. context: pure.
[[nodiscard]] std::vector<RoundForm> round_starts(const ChosenPoints& points, RoundKind kind);

}  // namespace fvd::metrology
