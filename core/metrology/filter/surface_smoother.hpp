#pragma once

/// One fit of all points of a surface with given weights: mean, local plane or local paraboloid.

#include <cstddef>

#include "core/image/image.hpp"
#include "core/metrology/filter/filter_settings.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

struct SmootherInput {
  const Plane<double>& z_um;     ///< 0 in holes
  const Plane<double>& weights;  ///< 0 in holes
  FilterMethod method;
  double nesting_px_x;
  double nesting_px_y;
};

/// smooth_um: NaN where the weighted points do not determine it or hold under kMinRegressionWeightShare of the kernel.
/// share: of the kernel's weight that lies on the weights. Both have the surface's shape already; every point is
/// written in place. pool may be null. context: pure.
void smooth_surface(const SmootherInput& input, WorkerPool* pool, Plane<double>& smooth_um, Plane<double>& share);

}  // namespace fvd::metrology
