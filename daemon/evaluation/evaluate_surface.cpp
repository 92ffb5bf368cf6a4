#include "daemon/evaluation/evaluate_surface.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/metrology/operations/region.hpp"
#include "core/surface/verdict.hpp"
#include "daemon/evaluation/field_check.hpp"
#include "daemon/evaluation/instrument_budget.hpp"
#include "daemon/evaluation/measure_kinds.hpp"
#include "daemon/evaluation/surface_chain.hpp"
#include "daemon/evaluation/value_uncertainty.hpp"

namespace fvd {

namespace {

using Measure = EvaluatedMeasurement (*)(const MeasurementInput& input);

constexpr std::array<std::pair<std::string_view, Measure>, 6> kKinds{{{"step_height", measure_step_height},
                                                                      {"step_between", measure_step_between},
                                                                      {"levels", measure_levels},
                                                                      {"areal", measure_areal},
                                                                      {"profile", measure_profile},
                                                                      {"cutting_edge", measure_edge}}};

EvaluatedMeasurement invalid_for(const std::string& reason, int code = 0) {
  EvaluatedMeasurement invalid;
  invalid.reason = reason;
  invalid.reason_code = code;
  return invalid;
}

/// A measurement that cannot be made costs its values alone, never the heights of the job.
EvaluatedMeasurement measured_by_kind(const MeasurementInput& input) {
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                 [&input](const auto& known) { return known.first == input.planned.kind; });
  if (!input.surface.refused.empty()) {
    return invalid_for("the surface " + input.planned.surface + " cannot be made: " + input.surface.refused,
                       input.surface.refused_code);
  }
  try {
    return kind->second(input);
  } catch (const std::bad_alloc&) {
    return invalid_for("there is not enough memory for it");
  } catch (const std::exception& error) {
    return invalid_for(error.what());
  }
}

void add_missing(const std::vector<std::string>& names, std::vector<std::string>& list) {
  for (const std::string& name : names) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  }
  std::sort(list.begin(), list.end());
}

/// The files of regions that are pictures, with their digests: in the details of what rests on them.
void note_masks(const MeasurementInput& input, EvaluatedMeasurement& made) {
  nlohmann::ordered_json digests = nlohmann::ordered_json::object();
  for (const std::string& name : used_regions(input.plan, input.planned)) {
    const auto mask = input.plan.masks.find(input.plan.regions.at(name).mask_png);
    if (mask != input.plan.masks.end()) digests[mask->first] = mask->second->sha256;
  }
  if (digests.empty()) return;
  nlohmann::ordered_json details = nlohmann::ordered_json::object();
  if (!made.details.empty()) details = nlohmann::ordered_json::parse(made.details);
  details["mask_sha256"] = std::move(digests);
  made.details = details.dump();
}

/// Where nothing was measured, each limit is missed by the lack of a value.
void add_invalid_values(const MeasurementInput& input, EvaluatedMeasurement& made) {
  for (const auto& [key, limits] : input.planned.limits) {
    if (made.values.contains(key)) continue;
    ValueInput none;
    none.reason = made.reason;
    made.values[key] = judged_value(none, key, input.planned, input.plan.decision);
  }
}

/// A measurement that is invalid as a whole has no value that passes.
void invalidate(EvaluatedMeasurement& made) {
  for (auto& [key, value] : made.values) {
    EvaluatedValue none;
    none.unit = value.unit;
    none.reason = value.value ? made.reason : value.reason;
    none.limits = value.limits;
    if (value.limits) none.verdict = Verdict::kInvalid;
    value = std::move(none);
  }
}

EvaluatedMeasurement made_whole(const std::string& id, const MeasurementInput& input) {
  EvaluatedMeasurement made = measured_by_kind(input);
  made.id = id;
  made.kind = input.planned.kind;
  made.surface = input.planned.surface;
  note_masks(input, made);
  add_missing(instrument_not_evaluated(input), made.not_evaluated);
  if (!knows_window(input.measured.field)) add_missing({"correlation"}, made.not_evaluated);
  made.warnings.insert(made.warnings.end(), input.surface.warnings.begin(), input.surface.warnings.end());
  for (EvaluationWarning& warning : partly_outside(input.plan, input.planned, metrology::grid_of(input.measured.field)))
    made.warnings.push_back(std::move(warning));
  if (!made.reason.empty()) {
    add_invalid_values(input, made);
    invalidate(made);
    if (!input.planned.limits.empty()) made.verdict = Verdict::kInvalid;  // nobody asked for a verdict on others
    if (made.reason_code == 0) made.reason_code = evaluation_code::kInvalid;
    return made;
  }
  std::vector<Verdict> verdicts;
  for (const auto& [key, value] : made.values) {
    if (value.verdict) verdicts.push_back(*value.verdict);
  }
  made.verdict = worst_verdict(verdicts);
  return made;
}

/// As many at a time as memory is reserved for, whatever the number of threads.
std::vector<EvaluatedMeasurement> all_made(const std::vector<MeasurementInput>& inputs, WorkerPool* pool) {
  std::vector<EvaluatedMeasurement> made(inputs.size());
  std::atomic<std::size_t> next{0};
  const auto lane = [&](int) {
    for (std::size_t i = next++; i < inputs.size(); i = next++) {
      made[i] = made_whole(plc_id(inputs[i].name, inputs[i].planned), inputs[i]);
    }
  };
  if (pool != nullptr) {
    pool->run(kMeasurementsAtOnce, std::ref(lane));
  } else {
    lane(0);
  }
  return made;
}

}  // namespace

Evaluation evaluate_surface(const SurfaceRef& surface, const EvaluationPlan& plan, const EvaluationContext& context,
                            WorkerPool* pool, const KeptPagesPtr& pages) {
  SurfaceChain chain(surface, plan, context, pool, pages);
  Evaluation evaluation;
  if (context.calibration) evaluation.calibration = context.calibration->id;
  evaluation.rule = plan.decision.rule;
  evaluation.probability = plan.decision.probability;
  std::optional<SliceSensitivity> slices = slice_sensitivity_of(context);
  const SurfaceState& measured = chain.state(kMeasuredSurface);
  std::vector<MeasurementInput> inputs;
  for (const auto& [name, planned] : plan.measurements) {
    inputs.push_back({plan, planned, chain.state(planned.surface), measured, context,
                      surface.lateral_period_um.value_or(0.0), name, pool, slices ? &*slices : nullptr});
  }
  std::vector<Verdict> verdicts;
  std::vector<EvaluatedMeasurement> finished = all_made(inputs, pool);
  for (std::size_t i = 0; i < finished.size(); ++i) {
    if (finished[i].verdict) verdicts.push_back(*finished[i].verdict);
    evaluation.measurements.emplace(inputs[i].name, std::move(finished[i]));
  }
  const std::string measured_steps = chain.state(kMeasuredSurface).steps_json;
  if (measured_steps != "[]") evaluation.surfaces[kMeasuredSurface] = measured_steps;
  for (const auto& [name, planned] : plan.surfaces) evaluation.surfaces[name] = chain.state(name).steps_json;
  for (const std::string& name : plan.order) {
    if (evaluation.measurements.contains(name)) evaluation.order.push_back(name);
  }
  for (const auto& [name, made] : evaluation.measurements) {
    if (std::find(evaluation.order.begin(), evaluation.order.end(), name) == evaluation.order.end()) {
      evaluation.order.push_back(name);
    }
  }
  evaluation.verdict = worst_verdict(verdicts);
  return evaluation;
}

}  // namespace fvd
