#pragma once

/// The focus curve of a white texture, for bench_accuracy: its Cramer-Rao bound is known.

#include <vector>

namespace fvd::bench {

/// F(u) of the modified Laplacian of neighbours at 1 px, u the defocus over the curve's full width at half maximum,
/// F(0) = 1: the root of the power that passes the diffraction-limited lens (cut-off 0.40 cycles/px), a Gaussian blur
/// in proportion to |u| and the second difference.
class ModelCurve {
 public:
  ModelCurve();
  [[nodiscard]] double at(double u) const;

 private:
  std::vector<double> values_;  // at u = 0, kTableStep_widths, ..
};

/// RMS error of the default peak through the accumulator on such curves with noise of 1 % of the peak, over the
/// Cramer-Rao bound of an estimator that knows the curve: sigma_z^2 = sigma^2 / sum F'(z_i - z)^2. Samples `step` apart
/// (in widths), at random offsets; bins as choose_bin_slices says. share: of curves that gave a height.
struct BoundRatio {
  double ratio = 0.0;
  double share = 0.0;
  double sigma_ratio = 0.0;
  int bin_slices = 1;
};
[[nodiscard]] BoundRatio rms_over_bound(const ModelCurve& curve, double step);

}  // namespace fvd::bench
