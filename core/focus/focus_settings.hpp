#pragma once

/// What a recipe may choose about the focus core.

#include <array>
#include <optional>
#include <string_view>

namespace fvd {

/// How a sub-slice height is taken from the peak triple.
enum class PeakMethod {
  kNearest,      ///< z of the sharpest slice
  kParabola,     ///< vertex of the parabola through the triple
  kLogParabola,  ///< vertex of the parabola through the logarithms (Gaussian peak; Nayar and Nakagawa 1994)
  kInverseRoot,  ///< vertex of the parabola through F^-1/2: exact for 1 / (a + b u^2)^2, a peak with heavy tails
};
inline constexpr std::array kAllPeakMethods{PeakMethod::kNearest, PeakMethod::kParabola, PeakMethod::kLogParabola,
                                            PeakMethod::kInverseRoot};

/// "nearest", "parabola", "log_parabola", "inverse_root".
[[nodiscard]] std::string_view peak_method_name(PeakMethod method) noexcept;
[[nodiscard]] std::optional<PeakMethod> peak_method_from_name(std::string_view name) noexcept;

inline constexpr int kMinWindowPx = 3;
inline constexpr int kMaxWindowPx = 63;
inline constexpr int kMaxDistancePx = 7;

struct FocusSettings {
  int window_px = 9;            ///< side of the square window of the sum, odd, 3..63
  int distance_px = 1;          ///< from a pixel to the neighbours of its Laplacian, 1..7
  double min_prominence = 0.5;  ///< (peak - minimum) / peak of the focus curve, 0..1; below it a point is a hole
};

/// Throws Error kBadInput with the value and its range.
void check_focus_settings(const FocusSettings& settings);

}  // namespace fvd
