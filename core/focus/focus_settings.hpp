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
};
inline constexpr std::array kAllPeakMethods{PeakMethod::kNearest, PeakMethod::kParabola, PeakMethod::kLogParabola};

/// "nearest", "parabola", "log_parabola".
[[nodiscard]] std::string_view peak_method_name(PeakMethod method) noexcept;
[[nodiscard]] std::optional<PeakMethod> peak_method_from_name(std::string_view name) noexcept;

inline constexpr int kMinWindowPx = 3;
inline constexpr int kMaxWindowPx = 63;

struct FocusSettings {
  int window_px = 9;            ///< side of the square window of the sum, odd, 3..63
  double min_prominence = 0.5;  ///< (peak - minimum) / peak of the focus curve, 0..1; below it a point is a hole
};

/// Throws Error kBadInput with the value and its range.
void check_focus_settings(const FocusSettings& settings);

}  // namespace fvd
