#pragma once

/// From one row's condensed focus curves to heights, their variances, prominence and reasons to be a hole.

#include <vector>

#include "core/focus/fit/sample_heights.hpp"
#include "core/focus/kernels/focus_kernels.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/focus/measure/sharpness_code.hpp"

namespace fvd {

/// What the noise of a pixel makes of a sample of the focus measure.
///
/// Modified Laplacian: the noise of the window's pixels adds up with random signs, sigma_F = c * window * sigma. With
/// independent signs c is sqrt(12), the weights 2, 2, 1, 1, 1, 1 squared; neighbours that share theirs make it more.
/// Tenengrad: the same of 2 g dg, so it grows with the root of F. Intensity: sigma_F = window * sigma.
[[nodiscard]] double sample_noise(const FocusSettings& settings, double noise_grey, double sharpness) noexcept;

/// context: const members from many threads.
class RowFit {
 public:
  /// z of the samples. bias: what is taken off the vertices of kFiveSample. misfit: see curve_misfit.hpp.
  RowFit(std::vector<double> z_um, const FocusSettings& settings, PixelFormat format, PeakMethod method,
         VertexBias bias = {}, double misfit = 0.0);

  /// Standard deviation of a sample at the peak, as shares, from that of each pixel. Shape [width] each.
  void find_noise(const CurveRow& row, const float* noise_grey, int width, float* noise) const noexcept;
  /// Whether it depends on the row's sharpness, and not on noise_grey alone.
  [[nodiscard]] bool noise_follows_sharpness() const noexcept {
    return settings_.focus_operator == FocusOperator::kTenengrad;
  }

  /// noise: of find_noise(). least_amplitude: of peak less minimum as shares, below which a point is edge bleeding.
  /// Shape [width] each.
  void fit(const CurveRow& row, const float* noise, const float* least_amplitude, int width,
           const FitRow& out) const noexcept;

  /// A code's share of full scale.
  [[nodiscard]] double share(std::uint16_t code) const noexcept {
    const double value = code * SharpnessCode::kUnit;
    return code_.root ? value * value : value;
  }

 private:
  void fit_triples(const CurveRow& row, const float* noise, const float* least_amplitude, int width,
                   const FitRow& out) const noexcept;

  FocusSettings settings_;
  SharpnessCode code_;
  PeakMethod method_;
  VertexBias bias_;
  float misfit_;
  std::vector<double> z_um_;
  std::vector<HeightEntry> heights_;
  double bin_gain_;  // from the mean code of a bin's slices to the bin's code
};

}  // namespace fvd
