#pragma once

/// One operation of a recipe, done to a surface.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/runtime/worker_pool.hpp"
#include "core/surface/mask_reason.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// pool may be null; reasons likewise, or of the shape of the surface: why its points are holes. The surface is
/// unchanged where the report has a refusal. context: pure.
[[nodiscard]] metrology::OperationReport apply_operation(const EvaluationPlan& plan, const PlannedOperation& step,
                                                         const EvaluationContext& context, WorkerPool* pool,
                                                         Plane<MaskReasons>* reasons, metrology::HeightField& field);

}  // namespace fvd
