#pragma once

/// What the focus curves of a scan look like, as against what the five-sample fit takes them for.
///
/// The fit is exact for F = (1 + b u^2)^-2. Real curves are near to F = (1 + b u^2)^-p, with p from 1.3 for coarse
/// grain to 2.2 where noise fills the tails. The fit's vertex then lies too near to the peak's sample or too far from
/// it, by what follows the fraction of a step: slopes get a ripple ("pixel locking" in z).
///
/// A scan tells p: with the right one, peak and neighbours foretell the samples two steps away, in the mean over some
/// thousand curves. What the fit makes of a curve of that p is then computed, and taken off every vertex.

#include <span>
#include <vector>

#include "core/focus/fit/curve_tuple.hpp"
#include "core/focus/kernels/focus_kernels.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

struct CurveShape {
  double exponent = 2.0;  ///< p; 2 where too few curves tell
  double width_um = 0.0;  ///< full width at half maximum, median; 0 unknown
  VertexBias bias;        ///< of the five-sample fit
};

/// Tuples: spread over the image, their indices within z_um. z_um: of the samples. context: computes on the pool too.
[[nodiscard]] CurveShape curve_shape(std::span<const CurveTuple> tuples, const std::vector<double>& z_um,
                                     WorkerPool& pool);

}  // namespace fvd
