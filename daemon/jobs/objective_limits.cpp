#include "daemon/jobs/objective_limits.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace fvd {

const ObjectiveConfig* find_objective(const std::vector<ObjectiveConfig>& objectives, const std::string& name) {
  const auto found = std::find_if(objectives.begin(), objectives.end(),
                                  [&name](const ObjectiveConfig& objective) { return objective.name == name; });
  return found == objectives.end() ? nullptr : &*found;
}

StageInfo limited_by(const ObjectiveConfig& objective, StageInfo stage) {
  if (objective.min_um) stage.min = std::max(stage.min, Micrometers{*objective.min_um});
  if (objective.max_um) stage.max = std::min(stage.max, Micrometers{*objective.max_um});
  return stage;
}

void check_limits(const ObjectiveConfig* objective, const StageInfo& stage,
                  const std::function<void(const StageInfo&)>& check) {
  check(stage);
  if (objective == nullptr) return;
  try {
    check(limited_by(*objective, stage));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kStageLimit) throw;
    throw Error(ErrorCode::kStageLimit,
                "with objective '" + objective->name + "', whose soft limits hold: " + error.what());
  }
}

}  // namespace fvd
