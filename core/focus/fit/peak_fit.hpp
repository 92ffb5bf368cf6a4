#pragma once

/// The sub-slice position of a focus curve's peak from three samples at uneven heights.

#include <optional>

#include "core/focus/measure/focus_settings.hpp"

namespace fvd {

/// Three neighbouring samples of a focus curve, the middle one the largest. Lengths in um; sharpness in any unit.
struct PeakTriple {
  double z_left_um = 0.0;
  double z_peak_um = 0.0;
  double z_right_um = 0.0;
  double left = 0.0;
  double peak = 0.0;
  double right = 0.0;
  double noise = 0.0;  ///< standard deviation of a sample
};

struct PeakPosition {
  double z_um = 0.0;
  double sigma_um = 0.0;  ///< standard error by the noise of the samples, to first order; kNearest: step / sqrt(12)
};

/// The peak, always between the neighbours' z. Nothing if the samples do not enclose a maximum (a neighbour above the
/// peak, or both equal to it) or their z are not monotonic. context: pure.
///
/// With d1 = z_left - z_peak, d3 = z_right - z_peak, a = g(left) - g(peak), b = g(right) - g(peak):
///   z = z_peak + (a d3^2 - b d1^2) / (2 (a d3 - b d1)),
/// the vertex of the parabola through the points. It is the mean of d3 / 2 and d1 / 2 with the weights a d3 and -b d1,
/// which have one sign: so it lies no further than half way to either neighbour. g is the identity (kParabola) or the
/// logarithm (kLogParabola, exact for a Gaussian curve) or -F^-1/2 (kInverseRoot, exact for F = 1 / (a + b u^2)^2).
/// For the last two, samples below `smallest` > 0 count as `smallest`. kFiveSample has a fit of its own,
/// five_sample_fit.hpp.
[[nodiscard]] std::optional<PeakPosition> fit_peak(PeakMethod method, const PeakTriple& triple,
                                                   double smallest) noexcept;

}  // namespace fvd
