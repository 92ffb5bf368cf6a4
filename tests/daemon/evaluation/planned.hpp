#pragma once

/// Plans from their JSON, for tests.

#include <string>

#include "config/field_reader.hpp"
#include "daemon/evaluation/check_plan.hpp"
#include "daemon/evaluation/evaluation_fields.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd::test {

/// Adds the problems of reading and of checking.
inline EvaluationPlan read_plan(const std::string& json, Problems& problems) {
  EvaluationPlan plan;
  read_document(
      json, [&plan](Fields& fields) { describe(plan, fields); }, problems);
  check_plan(plan, "", problems);
  return plan;
}

}  // namespace fvd::test
