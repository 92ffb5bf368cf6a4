#include "daemon/jobs/job_check.hpp"

#include "core/base/error.hpp"
#include "core/scan/continuous_scan.hpp"
#include "daemon/evaluation/field_check.hpp"
#include "daemon/jobs/objective_limits.hpp"
#include "daemon/pipeline/job_memory.hpp"
#include "daemon/pipeline/measurement.hpp"

namespace fvd {

void require_acceptable(const Recipe& recipe, const std::optional<DeviceFacts>& devices,
                        const ObjectiveConfig* objective, const ComputeLimits& limits) {
  if (!devices) throw Error(ErrorCode::kNotReady, "a device is being opened anew; try again when the machine is ready");
  const ScanPlan plan = scan_plan(recipe);
  if (recipe.mode == ScanMode::kContinuous) check_continuous(plan, recipe.camera, devices->stage);
  check_limits(objective, devices->stage, [&plan](const StageInfo& stage) { check_plan(plan, stage); });
  const int width = recipe.camera.width > 0 ? recipe.camera.width : devices->camera.sensor_width;
  const int height = recipe.camera.height > 0 ? recipe.camera.height : devices->camera.sensor_height;
  const metrology::Grid field{width, height, recipe.pixel_pitch_x_um, recipe.pixel_pitch_y_um};
  throw_if_any(outside_field(recipe.evaluation, field, "/evaluation"), ErrorCode::kRegionOutside,
               "recipe " + recipe.id);
  require_memory(job_memory(recipe, width, height, limits.threads), width, height, limits.memory_bytes,
                 limits.pages.get());
}

}  // namespace fvd
