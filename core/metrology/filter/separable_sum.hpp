#pragma once

/// Sums of a plane, weighted by a separable kernel.

#include "core/image/image.hpp"
#include "core/metrology/filter/moment_rows.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// Reach in x and y together above which separable_sum() transforms instead of adding up.
inline constexpr int kLongReachPx = 24;

/// Sum of the source weighted by the kernel around every point; outside the plane the source is 0, and it has no NaN.
/// Short kernels are added up, long ones go through MomentRows. pool may be null. context: pure.
[[nodiscard]] Plane<double> separable_sum(const Plane<double>& source, const SeparableKernel& kernel, WorkerPool* pool);

}  // namespace fvd::metrology
