#pragma once

/// The kinds of measurement, each from a surface to an entry of the result.

#include <string>

#include "core/focus/fit/slice_sensitivity.hpp"
#include "core/metrology/height_field.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"
#include "daemon/evaluation/surface_chain.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// What a measurement is made on. Everything outlives it.
struct MeasurementInput {
  const EvaluationPlan& plan;
  const PlannedMeasurement& planned;
  const SurfaceState& surface;   ///< that was made
  const SurfaceState& measured;  ///< as the scan made it
  const EvaluationContext& context;
  double lateral_period_um = 0.0;      ///< that the measured surface shows at half its amplitude; 0 = not known
  std::string name = {};               ///< of the measurement in its plan
  WorkerPool* pool = nullptr;          ///< null = everything on the caller's thread; the values are the same
  SliceSensitivity* slices = nullptr;  ///< what errors of slices do; null = not known
};

/// Each never throws for data: what cannot be given is absent with a reason. context: one thread.
[[nodiscard]] EvaluatedMeasurement measure_step_height(const MeasurementInput& input);
[[nodiscard]] EvaluatedMeasurement measure_step_between(const MeasurementInput& input);
[[nodiscard]] EvaluatedMeasurement measure_levels(const MeasurementInput& input);
[[nodiscard]] EvaluatedMeasurement measure_areal(const MeasurementInput& input);
[[nodiscard]] EvaluatedMeasurement measure_profile(const MeasurementInput& input);
[[nodiscard]] EvaluatedMeasurement measure_edge(const MeasurementInput& input);

}  // namespace fvd
