#pragma once

/// A second map beside the measured one: each height from a quadratic surface that is fitted to the heights about it.
///
/// Local polynomial regression (W. S. Cleveland, JASA 74(368), 1979) of degree 2 with Gaussian weights of standard
/// deviation s: slopes and curvatures pass, noise is averaged over about 8 s^2 pixels. The heights of a focus map are
/// noisy with the correlation of its window, so a small window and this make less error than a large window of the same
/// lateral resolution, which also averages curves of different heights to one that fits neither.
///
/// Valid points alone are used and changed: what was a hole stays one. Where the heights scatter about the quadratic by
/// more than their errors, as beside walls, only those of the point's own surface are used.

#include <limits>

#include "core/image/image.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

inline constexpr double kMinSmoothPx = 1.0;
inline constexpr double kMaxSmoothPx = 16.0;

struct SmoothSettings {
  double sigma_px = 4.0;       ///< standard deviation of the weights, kMinSmoothPx..kMaxSmoothPx
  double correlated_px = 1.0;  ///< area over which the errors of the heights are one, px^2, >= 1
  /// Where a quadratic does not hold, neighbours that are higher or lower by more lie beyond a wall, > 0.
  double jump_um = std::numeric_limits<double>::infinity();
};

/// Shape of the input; NaN where the input is.
struct SmoothedHeights {
  Plane<float> height_m;
  /// Standard error: the mean one of the points used, or what they scatter about the quadratic if that is more, over
  /// the root of the number of independent points.
  Plane<float> sigma_m;
};

/// height_m: metres, NaN in holes; sigma_m: of one shape with it, metres. A point in whose neighbourhood a quadratic is
/// not determined stays as it was measured. Takes about 10 * (6 * sigma_px + 1) rows of double per thread beside the
/// result. Throws Error kBadInput for a setting outside its range. context: one thread at a time per
/// pool; spreads its work over the pool.
[[nodiscard]] SmoothedHeights smooth_heights(const Plane<float>& height_m, const Plane<float>& sigma_m,
                                             const SmoothSettings& settings, WorkerPool& pool);

}  // namespace fvd
