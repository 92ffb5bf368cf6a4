#pragma once

/// The surfaces of an evaluation, each made once from the one that it comes from.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/metrology/height_field.hpp"
#include "core/runtime/worker_pool.hpp"
#include "core/surface/surface.hpp"
#include "core/surface/surface_ref.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// A surface after its steps.
struct SurfaceState {
  metrology::HeightField field;
  std::string steps_json;              ///< list of objects: each step with its settings, and what it did
  std::optional<double> s_nesting_um;  ///< the longest S filter on the way from the measured surface
  std::optional<double> l_nesting_um;  ///< the shortest L filter
  bool uses_sigma = false;             ///< a step on that way looked at the standard errors
  double removed_slope_x = 0.0;        ///< of the planes that were taken away: heights are along z of before
  double removed_slope_y = 0.0;
  bool robust = false;    ///< points were judged by the heights themselves
  bool levelled = false;  ///< a form was fitted and taken away on that way, with errors of its own
  std::vector<EvaluationWarning> warnings;
  /// Measured heights of the scan over those of the surface "measured": alpha_z of the calibration.
  double z_scale = 1.0;
  Plane<MaskReasons> reasons;         ///< why points are holes; empty where no step asks
  bool reference_subtracted = false;  ///< of flatness
  int refused_code = 0;               ///< evaluation_code of `refused`; 0 = no special one
  std::string refused;                ///< why the surface cannot be made; empty = it is there
};

/// Whether the surface tells what its focus window did: which neighbours share their errors.
[[nodiscard]] inline bool knows_window(const metrology::HeightField& measured) {
  return measured.kernel.weights.size() > 1;
}

/// Where an evaluation computes, and in what memory.
struct EvaluationMeans {
  WorkerPool* pool = nullptr;    ///< null = on the caller's thread alone; the values are the same
  KeptPagesPtr pages = nullptr;  ///< where the memory of surfaces comes from and goes to, if given
};

/// What surface refers to, plan, context and pool outlive it; pool may be null. context: one thread.
class SurfaceChain {
 public:
  SurfaceChain(SurfaceRef surface, const EvaluationPlan& plan, const EvaluationContext& context, WorkerPool* pool,
               KeptPagesPtr pages = nullptr);

  /// kMeasuredSurface or one of the plan's; the plan was checked.
  [[nodiscard]] const SurfaceState& state(const std::string& name);

 private:
  [[nodiscard]] SurfaceState measured() const;
  [[nodiscard]] SurfaceState made(const PlannedSurface& planned);

  SurfaceRef surface_;
  const EvaluationPlan& plan_;
  const EvaluationContext& context_;
  EvaluationMeans means_;
  std::map<std::string, SurfaceState> states_;
};

}  // namespace fvd
