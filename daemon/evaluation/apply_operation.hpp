#pragma once

/// One operation of a recipe, done to a surface.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// pool may be null. The surface is unchanged where the report has a refusal. context: pure.
[[nodiscard]] metrology::OperationReport apply_operation(const EvaluationPlan& plan, const PlannedOperation& step,
                                                         WorkerPool* pool, metrology::HeightField& field);

}  // namespace fvd
