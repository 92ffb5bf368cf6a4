#pragma once

/// The lateral resolution of a height map.

#include <optional>

#include "core/focus/measure/focus_settings.hpp"

namespace fvd {

/// Period of a sinusoidal surface whose amplitude a height map shows at one half, in pixels (the lateral period limit
/// of ISO 25178-600, along a row). The transfer of a map is the product of those of
///
///   each box of the window, n px:       sin(pi n f) / (n sin(pi f))
///   the operator, neighbours at d px:   exp(-2 pi^2 f^2 c d^2), c measured for each operator by bench_accuracy
///   the smoothing, weights of s px:     (1 + w) exp(-w), w = 2 pi^2 f^2 s^2 (a local quadratic, Gaussian weights)
///
/// for structures that are low against the focus curve's width. smooth_px: of smooth_heights(); nothing = not smoothed.
/// context: pure.
[[nodiscard]] double lateral_period_px(const FocusSettings& settings, std::optional<double> smooth_px) noexcept;

}  // namespace fvd
