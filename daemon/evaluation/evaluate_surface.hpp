#pragma once

/// A whole evaluation: the one code for jobs, recorded slices and surfaces from files.

#include "core/base/large_array.hpp"
#include "core/runtime/worker_pool.hpp"
#include "core/surface/surface.hpp"
#include "core/surface/surface_ref.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// So many measurements are made at a time, and need memory: those of a line's part on the two cores of its machine.
inline constexpr int kMeasurementsAtOnce = 2;

/// plan: checked, see check_plan(). pool may be null; the values do not depend on it. pages: where the memory of
/// surfaces comes from and goes to, if given. Never throws for data: what cannot be measured is invalid, with a reason.
/// context: pure.
[[nodiscard]] Evaluation evaluate_surface(const SurfaceRef& surface, const EvaluationPlan& plan,
                                          const EvaluationContext& context, WorkerPool* pool,
                                          const KeptPagesPtr& pages = nullptr);

}  // namespace fvd
