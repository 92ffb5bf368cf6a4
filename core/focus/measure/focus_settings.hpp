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
  kDiagonalLaplacian,  ///< the same and half of those along the diagonals (Thelen et al. 2009), see sharpness_rows.hpp
  kTenengrad,          ///< squared Sobel gradients (Tenenbaum 1970)
  kIntensity,          ///< the grey level itself, the response of a confocal microscope
};
inline constexpr std::array kAllFocusOperators{FocusOperator::kModifiedLaplacian, FocusOperator::kDiagonalLaplacian,
                                               FocusOperator::kTenengrad, FocusOperator::kIntensity};

/// "modified_laplacian", "diagonal_laplacian", "tenengrad", "intensity".
[[nodiscard]] std::string_view focus_operator_name(FocusOperator op) noexcept;
[[nodiscard]] std::optional<FocusOperator> focus_operator_from_name(std::string_view name) noexcept;

/// How the operator's values are weighted over the window.
enum class FocusWindow {
  kBox,        ///< all alike
  kDoubleBox,  ///< the mean of a box over the means of another: weights that fall towards the rim, see WindowSides
};
inline constexpr std::array kAllFocusWindows{FocusWindow::kBox, FocusWindow::kDoubleBox};

/// "box", "double_box".
[[nodiscard]] std::string_view focus_window_name(FocusWindow window) noexcept;
[[nodiscard]] std::optional<FocusWindow> focus_window_from_name(std::string_view name) noexcept;

inline constexpr int kMinWindowPx = 3;
inline constexpr int kMaxWindowPx = 63;
inline constexpr int kMaxDistancePx = 7;

inline constexpr int kMaxBinSlices = 64;
inline constexpr int kMaxSlicesOfAScan = 65535;
inline constexpr int kMaxEdgeBandSlices = 65535;
inline constexpr double kMaxSigmaLimit_um = 1e6;
/// Of a second peak: the valley before it lies below three quarters of the limit, and of a lower limit so low that
/// noise fills it. Then fewer second peaks would be found, not more.
inline constexpr double kLeastSecondPeak = 0.5;

/// What makes a hole of a point beside prominence and significance; README.md of core/focus/fit says where the limits
/// come from. 0 turns a test off.
struct PointTests {
  double broad_curve = 0.2;  ///< the bend of a point's curve over the scan's median, 0..1; below it a point is a hole
  double narrow_curve =
      0.55;  ///< the width of a point's curve over the scan's median, 0..1; below it a point is a hole
  double clipped_share = 0.7;  ///< of the window's pixels at the peak, 0..1; if more are at full scale, or noticeably
                               ///< more beside the peak than at it, a point is a hole
  int edge_band_slices = 3;    ///< neighbours' heights that are further apart, and further than a curve is wide, make
                               ///< holes of the strip beside them, see edge_band.hpp; >= 0
  double second_peak = 0.0;   ///< height over the curve's minimum of a second peak over that of the first, 0 or 0.5..1;
                              ///< above it a point is a hole; takes 2 bytes more per pixel, see second_peak
  double max_sigma_um = 0.0;  ///< standard error of a height above which a point is a hole, >= 0
  bool operator==(const PointTests&) const = default;
};

/// Whether a single pixel has a value of its own: then a window may be one.
[[nodiscard]] constexpr bool has_point_window(FocusOperator op) noexcept { return op == FocusOperator::kIntensity; }

/// Whether the five-sample fit takes the logarithm of its curves, see five_sample_fit.hpp.
[[nodiscard]] constexpr bool has_light_tails(FocusOperator op) noexcept { return op == FocusOperator::kIntensity; }

struct FocusSettings {
  FocusOperator focus_operator = FocusOperator::kDiagonalLaplacian;
  FocusWindow window = FocusWindow::kDoubleBox;
  int window_px = 9;              ///< side of the square window of the sum, odd, 3..63; 1 for the intensity
  int distance_px = 2;            ///< from a pixel to the neighbours that its operator uses, 1..7
  double min_prominence = 0.5;    ///< (peak - minimum) / peak of the focus curve, 0..1; below it a point is a hole
  double min_significance = 6.0;  ///< (peak - minimum) / noise of a sample, >= 0; below it a point is a hole
  int bin_slices = 1;             ///< successive slices whose sharpness is summed to one sample of the curve, 1..64
  bool stage_correction = true;   ///< see stage_correction.hpp; with the five-sample peak only
  PointTests tests = {};
};

/// The sides of the boxes that are laid over each other.
struct WindowSides {
  int first = 0;   ///< px, odd
  int second = 1;  ///< px, odd; 1 where the window is a single box
};

/// Of a double box: the largest two odd sides, equal or 2 px apart, whose weights spread no further than those of one
/// box of window_px: the variance of a box of side n is (n^2 - 1) / 12 px^2 and those of both add up. 7 and 5 for 9 px.
[[nodiscard]] WindowSides window_sides(const FocusSettings& settings) noexcept;

/// The root of the sum of the squared weights, so many single values does the noise of the sum amount to: window_px for
/// a box.
[[nodiscard]] double window_norm(const FocusSettings& settings) noexcept;

/// The square of the sum of the weights over the sum of their squares: the area over which the noise of neighbouring
/// sums is one. window_px^2 for a box.
[[nodiscard]] double window_area_px2(const FocusSettings& settings) noexcept;

/// The number of slices per bin with which samples lie about 0.35 of the curve's full width at half maximum apart.
/// There the peak is located best: closer samples differ by more noise than signal. 1 if the width is unknown (0).
/// A short scan has fewer slices in a bin: eight samples at the least, or the peaks near its ends are lost.
/// context: pure.
[[nodiscard]] int choose_bin_slices(double step_um, double curve_width_um, int slices = kMaxSlicesOfAScan) noexcept;

/// Throws Error kBadInput with the value and its range.
void check_focus_settings(const FocusSettings& settings);

}  // namespace fvd
