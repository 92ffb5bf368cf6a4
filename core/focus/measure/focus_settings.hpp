#pragma once

/// The settings of the focus core that a recipe may choose.

#include <array>
#include <optional>
#include <string_view>

namespace fvd {

/// How a sub-slice height is computed from the samples about the peak.
enum class PeakMethod {
  kNearest,      ///< z of the sharpest slice
  kParabola,     ///< vertex of the parabola through the triple
  kLogParabola,  ///< vertex of the parabola through the logarithms (Gaussian peak; Nayar and Nakagawa 1994)
  kInverseRoot,  ///< vertex of the parabola through F^-1/2: exact for 1 / (a + b u^2)^2, a peak with heavy tails
  kFiveSample,   ///< the same parabola by least squares over five samples; see five_sample_fit.hpp
};
inline constexpr std::array kAllPeakMethods{PeakMethod::kNearest, PeakMethod::kParabola, PeakMethod::kLogParabola,
                                            PeakMethod::kInverseRoot, PeakMethod::kFiveSample};

/// "nearest", "parabola", "log_parabola", "inverse_root", "five_sample".
[[nodiscard]] std::string_view peak_method_name(PeakMethod method) noexcept;
[[nodiscard]] std::optional<PeakMethod> peak_method_from_name(std::string_view name) noexcept;

/// The operator whose values are summed over the window.
enum class FocusOperator {
  kModifiedLaplacian,  ///< absolute second differences along x and y (Nayar and Nakagawa 1994)
  kTenengrad,          ///< squared Sobel gradients (Tenenbaum 1970)
  kIntensity,          ///< the grey level itself, the response of a confocal microscope
};
inline constexpr std::array kAllFocusOperators{FocusOperator::kModifiedLaplacian, FocusOperator::kTenengrad,
                                               FocusOperator::kIntensity};

/// "modified_laplacian", "tenengrad", "intensity".
[[nodiscard]] std::string_view focus_operator_name(FocusOperator op) noexcept;
[[nodiscard]] std::optional<FocusOperator> focus_operator_from_name(std::string_view name) noexcept;

inline constexpr int kMinWindowPx = 3;
inline constexpr int kMaxWindowPx = 63;
inline constexpr int kMaxDistancePx = 7;

inline constexpr int kMaxBinSlices = 64;

struct FocusSettings {
  FocusOperator focus_operator = FocusOperator::kModifiedLaplacian;
  int window_px = 9;              ///< side of the square window of the sum, odd, 3..63; 1 for the intensity
  int distance_px = 2;            ///< from a pixel to the neighbours that its operator uses, 1..7
  double min_prominence = 0.5;    ///< (peak - minimum) / peak of the focus curve, 0..1; below it a point is a hole
  double min_significance = 6.0;  ///< (peak - minimum) / noise of a sample, >= 0; below it a point is a hole
  int bin_slices = 1;             ///< successive slices whose sharpness is summed to one sample of the curve, 1..64
  bool stage_correction = true;   ///< see stage_correction.hpp; with the five-sample peak only
};

/// The number of slices per bin with which samples lie about 0.4 of the curve's full width at half maximum apart. There
/// the peak is located best: closer samples differ by more noise than signal. 1 if the width is unknown (0).
/// context: pure.
[[nodiscard]] int choose_bin_slices(double step_um, double curve_width_um) noexcept;

/// Throws Error kBadInput with the value and its range.
void check_focus_settings(const FocusSettings& settings);

}  // namespace fvd
