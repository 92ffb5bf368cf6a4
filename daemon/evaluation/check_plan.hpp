#pragma once

/// What the keys of an evaluation say together.

#include "config/problem.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// Adds every problem with its JSON pointer under `place`: names that nothing has, circles of surfaces and regions,
/// filters that leave nothing, crossed limits, limits of values that a measurement does not have. What rests on a key
/// that is among the problems already is passed over.
void check_plan(const EvaluationPlan& plan, const std::string& place, Problems& problems);

}  // namespace fvd
