#pragma once

/// A filter step of a recipe.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// step: of op "filter". Refused where the nesting index is too short for the pitch. Warns where the S filter is
/// shorter than two focus windows, which have taken those wavelengths already, where the border moves the result by
/// more than the noise, and where a robust filter did not settle. context: pure.
[[nodiscard]] metrology::OperationReport filter_operation(const PlannedOperation& step, WorkerPool* pool,
                                                          metrology::HeightField& field);

}  // namespace fvd
