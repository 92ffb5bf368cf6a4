#pragma once

/// The shape of a scan's focus curves, and the error that the five-sample fit makes because of it.
///
/// The fit is exact for F = (1 + b u^2)^-2. Real curves are near to F = (1 + b u^2)^-p, with p from 1.3 for coarse
/// grain to 2.2 where noise fills the tails. The fit's vertex then lies too near to the peak's sample or too far from
/// it, by an amount that depends on the fraction of a step: slopes get a ripple ("pixel locking" in z).
///
/// Curves without heavy tails are fitted by their logarithm, exact for a Gaussian, which is p without end. Their p may
/// be anything up to that, for which kGaussianExponent stands, and negative: (1 - |b| u^2)^|p| has tails that end.
///
/// p is estimated from the scan: with the right p, the peak and its neighbours predict the samples two steps away, in
/// the mean over some thousand curves. The fit's error for a curve of that p is computed and subtracted from every
/// vertex.

#include <cmath>
#include <span>
#include <vector>

#include "core/focus/fit/curve_tuple.hpp"
#include "core/focus/kernels/focus_kernels.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// (1 + b u^2 / p)^-p is then within 0.001 of exp(-b u^2).
inline constexpr double kGaussianExponent = 1000.0;

struct CurveShape {
  double exponent = 2.0;  ///< p; that of the fit if there are too few curves to estimate it
  double width_um = 0.0;  ///< full width at half maximum, median; 0 unknown
  VertexBias bias;        ///< of the five-sample fit
};

/// F of a scan's curves, 1 at the vertex. The shape has a width.
class ScanCurve {
 public:
  explicit ScanCurve(const CurveShape& shape) noexcept
      : exponent_(shape.exponent),
        bend_per_um2_((std::exp2(1.0 / shape.exponent) - 1.0) * 4.0 / (shape.width_um * shape.width_um)) {}
  [[nodiscard]] double at(double away_um) const noexcept {
    return std::pow(1.0 + bend_per_um2_ * away_um * away_um, -exponent_);
  }
  /// at(away_um) / at(other_um)
  [[nodiscard]] double ratio(double away_um, double other_um) const noexcept {
    return std::pow((1.0 + bend_per_um2_ * other_um * other_um) / (1.0 + bend_per_um2_ * away_um * away_um), exponent_);
  }

 private:
  double exponent_;
  double bend_per_um2_;
};

/// tuples: spread over the image, their indices within z_um. z_um: measured z of each sample. context: computes on the
/// caller's thread and on the pool. logarithm: of the fit.
[[nodiscard]] CurveShape curve_shape(std::span<const CurveTuple> tuples, const std::vector<double>& z_um,
                                     WorkerPool& pool, bool logarithm = false);

}  // namespace fvd
