#pragma once

/// The regions of a plan on a field.

#include <optional>
#include <string>

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/region.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// Why the mask is no region of such a surface; absent where it is one.
[[nodiscard]] std::optional<std::string> mask_problem(const RegionMask& mask, const metrology::Grid& grid);

/// The points of the plan's region of this name; the empty name stands for every point, and gives the empty plane. The
/// plan was checked. Throws Error(kBadRecipe) where a region cannot be drawn. context: pure.
[[nodiscard]] metrology::Region region_points(const EvaluationPlan& plan, const std::string& name,
                                              const metrology::HeightField& field);

}  // namespace fvd
