#pragma once

/// The five-sample fit of one curve in double precision, written from the formula in five_sample_fit.hpp as a
/// least-squares problem with a matrix. The kernels, which split its sums for speed, are tested against it; gap_bias
/// asks it of some hundred curves.

#include <array>
#include <optional>

#include "core/focus/kernels/focus_kernels.hpp"

namespace fvd {

struct ReferenceSample {
  double z_um = 0.0;
  double share = 0.0;  ///< sharpness as a share of full scale
};

struct ReferenceCurve {
  ReferenceSample peak;
  ReferenceSample left;                       ///< the sample before the peak
  ReferenceSample right;                      ///< the sample after it
  std::optional<ReferenceSample> left2 = {};  ///< the one before left, where there is one and z runs on to it
  std::optional<ReferenceSample> right2 = {};
  double minimum = 0.0;      ///< of the whole curve, as a share of full scale
  double noise = 0.0;        ///< standard deviation of a sample, as a share of full scale
  double misfit = 0.0;       ///< what a sample has beside that, as a share of the curve's amplitude
  double shape_error = 0.0;  ///< kShapeError or kBinnedShapeError
  VertexBias bias = {};      ///< to be taken off
};

struct ReferencePeak {
  double z_um = 0.0;
  double sigma_um = 0.0;
};

/// Nothing if the parabola has no vertex between the neighbours. Needs peak.share > 0.9 minimum, and left and right on
/// two sides of the peak. context: pure.
[[nodiscard]] std::optional<ReferencePeak> fit_reference(const ReferenceCurve& curve);

}  // namespace fvd
