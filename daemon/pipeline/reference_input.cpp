#include "daemon/pipeline/reference_input.hpp"

#include <algorithm>

#include "daemon/surface_files/reference_map.hpp"

namespace fvd {

bool asks_for_reference(const EvaluationPlan& plan) {
  const auto asks = [](const PlannedOperation& step) { return step.op == "flatness_reference"; };
  return std::any_of(plan.surfaces.begin(), plan.surfaces.end(), [&asks](const auto& surface) {
    return std::any_of(surface.second.steps.begin(), surface.second.steps.end(), asks);
  });
}

void read_reference_of(const std::filesystem::path& calibration_folder, const EvaluationPlan& plan,
                       EvaluationContext& context) {
  const auto& calibration = context.calibration;
  if (!calibration || !calibration->flatness || calibration->flatness->reference.empty()) return;
  if (calibration_folder.empty() || !asks_for_reference(plan)) return;
  context.flatness_reference = read_reference_map(calibration_folder, calibration->flatness->reference);
}

}  // namespace fvd
