#pragma once

/// From one row's condensed focus curves to heights, their variances, prominence and reasons to be a hole.

#include <array>
#include <vector>

#include "core/focus/fit/curve_limits.hpp"
#include "core/focus/fit/sample_heights.hpp"
#include "core/focus/kernels/focus_kernels.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/focus/measure/sharpness_code.hpp"

namespace fvd {

/// Standard deviation of a sample of the focus measure that a pixel noise of noise_grey grey levels causes.
///
/// Modified Laplacian: the noise of the window's pixels adds up with random signs, sigma_F = c * window * sigma. With
/// independent signs c is sqrt(12), from the squares of the weights 2, 2, 1, 1, 1, 1; neighbours share pixels, which
/// raises it to 4.0, measured. Tenengrad: the same for 2 g dg, so it grows with the root of F. Intensity: sigma_F =
/// window * sigma.
[[nodiscard]] double sample_noise(const FocusSettings& settings, double noise_grey, double sharpness) noexcept;

/// What all curves of a scan have in common.
struct ScanCurves {
  VertexBias bias;      ///< subtracted from the vertices of kFiveSample
  double misfit = 0.0;  ///< see curve_misfit.hpp
  CurveLimits limits;
};

/// context: const members from many threads.
class RowFit {
 public:
  /// z_um: measured z of each sample.
  RowFit(std::vector<double> z_um, const FocusSettings& settings, PixelFormat format, PeakMethod method,
         const ScanCurves& curves = {});

  /// Writes the standard deviation of a sample at the peak, as shares of full scale. noise_grey: standard deviation of
  /// each pixel in grey levels. Shape [width] each.
  void find_noise(const CurveRow& row, const float* noise_grey, int width, float* noise) const noexcept;
  /// True if find_noise() depends on the row's sharpness, and not on noise_grey alone.
  [[nodiscard]] bool noise_follows_sharpness() const noexcept {
    return settings_.focus_operator == FocusOperator::kTenengrad;
  }

  /// noise: from find_noise(). least_amplitude: peak minus minimum, as a share of full scale, below which a point is
  /// edge bleeding. Shape [width] each.
  void fit(const CurveRow& row, const float* noise, const float* least_amplitude, int width,
           const FitRow& out) const noexcept;

  /// The share of full scale that a code stands for.
  [[nodiscard]] double share(std::uint16_t code) const noexcept {
    const double value = code * SharpnessCode::kUnit;
    return code_.root ? value * value : value;
  }
  /// Of the five samples about a peak, over the floor and as shares of the peak's; see CurveTuple.
  [[nodiscard]] std::array<float, 5> shares(const CurveRow& row, int x) const noexcept;

 private:
  void fit_triples(const CurveRow& row, const float* noise, const float* least_amplitude, int width,
                   const FitRow& out) const noexcept;
  /// Points whose second peak is too high become holes, but those that have no peak at all.
  void mark_second_peaks(const CurveRow& row, int width, const FitRow& out) const noexcept;
  /// Broad or narrow, by the samples and their distances.
  [[nodiscard]] unsigned shape_reasons(const CurveRow& row, int x) const noexcept;

  FocusSettings settings_;
  SharpnessCode code_;
  PeakMethod method_;
  ScanCurves curves_;
  std::vector<double> z_um_;
  std::vector<HeightEntry> heights_;
  double bin_gain_;  // from the mean code of a bin's slices to the bin's code
};

}  // namespace fvd
