#pragma once

/// From a number and what is known of its errors to a value with U and verdict.

#include <optional>
#include <string>

#include "core/focus/fit/slice_sensitivity.hpp"
#include "core/metrology/height_field.hpp"
#include "core/metrology/uncertainty/budget.hpp"
#include "core/metrology/uncertainty/linear_noise.hpp"
#include "core/metrology/uncertainty/weight_map.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// Everything that a value's uncertainty and verdict follow from.
struct ValueInput {
  std::optional<double> value;
  std::string reason;        ///< why there is no value
  metrology::Budget budget;  ///< without entries: U is not known
  std::string u_method;      ///< "linear", "monte_carlo", "jacobian", "spread", "repeated"
  bool below_noise = false;  ///< of a texture value
  bool exact = false;        ///< a count or a share of points: judged by itself
};

/// Adds noise to the budget, or "noise" to what is not evaluated where the field has no standard errors.
void add_noise(const std::optional<metrology::LinearNoise>& noise, metrology::Budget& budget);

/// The sensitivity to the slices' z, where the context knows them and they rise or fall throughout.
[[nodiscard]] std::optional<SliceSensitivity> slice_sensitivity_of(const EvaluationContext& context);

/// Adds the errors of the slices' z, which whole plateaus share. weights: of the value, on the measured field, whose
/// heights, times z_scale, tell which slices each point rests on; a step that moved points along x by a few columns is
/// not undone for that. "slice_z" is not evaluated where the input has no sensitivity to slices.
void add_slice_z(const MeasurementInput& input, const metrology::WeightMap& weights, metrology::Budget& budget);

/// Adds what this budget does not contain to what the measurement says of all its budgets.
void note_not_evaluated(const metrology::Budget& budget, EvaluatedMeasurement& made);

/// key: of the value in `planned`, whose limits and `decision` make the verdict.
[[nodiscard]] EvaluatedValue judged_value(const ValueInput& input, const std::string& key,
                                          const PlannedMeasurement& planned, const PlannedDecision& decision);

}  // namespace fvd
