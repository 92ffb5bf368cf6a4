#pragma once

/// How long a job may go on without a sign of life.

#include <chrono>

#include "core/hw/axis.hpp"
#include "daemon/recipes/recipe.hpp"

namespace fvd {

/// An upper bound of the time from one phase or slice of the recipe's job to the next while nothing hangs: with every
/// move and frame as late as the recipe, or the drive's profile, lets it be, the job fails by itself within it.
/// context: pure.
[[nodiscard]] std::chrono::milliseconds longest_step(const Recipe& recipe, const StageInfo& stage);

}  // namespace fvd
