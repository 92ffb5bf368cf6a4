#pragma once

/// The reference map for an evaluation, from the folder of the calibration.

#include <filesystem>

#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// Whether a surface of the plan is corrected by the reference map.
[[nodiscard]] bool asks_for_reference(const EvaluationPlan& plan);

/// The map that the context's constants name, where the plan asks for one; else, and without a folder, nothing is read.
/// Throws Error kSurfaceFile as read_reference_map(). context: thread-safe.
void read_reference_of(const std::filesystem::path& calibration_folder, const EvaluationPlan& plan,
                       EvaluationContext& context);

}  // namespace fvd
