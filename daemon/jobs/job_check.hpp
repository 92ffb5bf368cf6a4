#pragma once

/// Whether a recipe can be run on the devices that are open.

#include <cstddef>
#include <optional>

#include "core/base/large_array.hpp"
#include "daemon/config/config.hpp"
#include "daemon/devices/device_hub.hpp"
#include "daemon/recipes/recipe.hpp"

namespace fvd {

struct ComputeLimits {
  int threads = 1;               ///< of the worker pool
  std::size_t memory_bytes = 0;  ///< budget of a job, with the pages that are kept for the next
  KeptPagesPtr pages = nullptr;  ///< may be null
};

/// objective: that was confirmed; nullptr = none. Throws Error kNotReady without devices, kStageLimit, kBadRecipe,
/// kMemoryBudget; kRegionOutside with everything of the evaluation that lies outside of the field of view, each with
/// its JSON pointer.
void require_acceptable(const Recipe& recipe, const std::optional<DeviceFacts>& devices,
                        const ObjectiveConfig* objective, const ComputeLimits& limits);

}  // namespace fvd
