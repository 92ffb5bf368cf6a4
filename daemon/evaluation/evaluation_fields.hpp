#pragma once

/// The keys of a recipe's section "evaluation": names, ranges, meanings.

#include "config/fields.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// Reads, writes and documents the section; names are looked up by check_plan(). The order of the measurements is not
/// of the fields, because JSON objects have none.
void describe(EvaluationPlan& plan, Fields& fields);
/// One step of a surface.
void describe(PlannedOperation& step, Fields& fields);

}  // namespace fvd
