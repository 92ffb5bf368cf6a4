#pragma once

/// The default peak: a parabola through G = -F^-1/2 by least squares over the peak's sample and two on either side.
///
/// F = 1 / (a + b u^2)^2 makes G a parabola exactly; the focus curve of a blurred texture is near to it, with tails
/// heavier than a Gaussian's. With additive noise of one size on F, G has the variance F^-3 / 4, so F^3 would be the
/// weight of least variance; F^4 trusts the tails a little less, where real curves leave the shape. From every sample
/// comes off kFloorShare of the curve's minimum, which is mostly the focus measure's response to noise.
///
/// sigma: the noise of each sample carried through the fit to first order, and kShapeError for curves of another shape.

namespace fvd {

inline constexpr float kFloorShare = 0.9F;
inline constexpr float kSmallestShare = 1e-3F;  ///< of the peak: what a sample at the floor counts as
inline constexpr float kShapeError = 0.01F;     ///< standard deviation, of the distance between samples

}  // namespace fvd
