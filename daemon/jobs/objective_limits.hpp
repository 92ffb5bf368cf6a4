#pragma once

/// Where an objective lets the stage go.

#include <functional>
#include <string>
#include <vector>

#include "core/hw/axis.hpp"
#include "daemon/config/config.hpp"

namespace fvd {

/// The objective of this name; nullptr if there is none. context: pure, as the next.
[[nodiscard]] const ObjectiveConfig* find_objective(const std::vector<ObjectiveConfig>& objectives,
                                                    const std::string& name);

/// The stage with the objective's soft limits in place of its own where they are narrower.
[[nodiscard]] StageInfo limited_by(const ObjectiveConfig& objective, StageInfo stage);

/// Calls `check` for the stage, which throws Error kStageLimit where its limits are not kept, then for the stage with
/// the objective's limits. objective: nullptr = none. Throws Error kStageLimit that names the objective where that
/// one's limits are not kept, and whatever else `check` throws.
void check_limits(const ObjectiveConfig* objective, const StageInfo& stage,
                  const std::function<void(const StageInfo&)>& check);

}  // namespace fvd
