#pragma once

/// The sub-slice position of a focus curve's peak from three samples at uneven heights.

#include <cstdint>
#include <optional>

#include "core/focus/focus_settings.hpp"

namespace fvd {

/// Three neighbouring samples of a focus curve, the middle one the largest. Lengths in um.
struct PeakTriple {
  double z_left_um = 0.0;
  double z_peak_um = 0.0;
  double z_right_um = 0.0;
  std::uint32_t left = 0;
  std::uint32_t peak = 0;
  std::uint32_t right = 0;
};

/// z of the peak in um, always between the neighbours' z. Nothing if the samples do not enclose a maximum
/// (a neighbour above the peak, or both equal to it) or their z do not run one way.
///
/// With d1 = z_left - z_peak, d3 = z_right - z_peak, a = g(left) - g(peak), b = g(right) - g(peak):
///   z = z_peak + (a d3^2 - b d1^2) / (2 (a d3 - b d1)),
/// the vertex of the parabola through the points. It is the mean of d3 / 2 and d1 / 2 with the weights a d3 and -b d1,
/// which have one sign: so it lies no further than half way to either neighbour. g is the identity (kParabola) or the
/// logarithm (kLogParabola, exact for a Gaussian curve) or -F^-1/2 (kInverseRoot, exact for F = 1 / (a + b u^2)^2). A
/// sample of 0 counts as half a count under the last two.
[[nodiscard]] std::optional<double> fit_peak_um(PeakMethod method, const PeakTriple& triple) noexcept;

}  // namespace fvd
