#pragma once

/// The default peak: a parabola through G = -F^-1/2 by least squares over the peak's sample and two on either side.
///
/// F = 1 / (a + b u^2)^2 makes G a parabola exactly; the focus curve of a blurred texture is near to it, with tails
/// heavier than a Gaussian's. With additive noise of one size on F, G has the variance F^-3 / 4, so F^3 would be the
/// weight of least variance; F^4 gives less weight to the tails, where real curves depart from the shape. kFloorShare
/// of the curve's minimum, which is mostly the focus measure's response to noise, is subtracted from every sample.
///
/// Curves without heavy tails, a confocal microscope's intensity, have a logarithm that is nearly a parabola (exactly
/// so for a Gaussian): G = -ln F, whose variance is F^-2, with the weights F^2 of least variance. They are alike all
/// over a surface: what they have beside the shape is taken off, and no error of the shape is left. Of sinc^2 at 0.05
/// to 0.5 widths the fit comes within 1.13 of the Cramer-Rao bound, the form above within 1.3 to 4.
///
/// The common departure of the scan's curves from that shape is subtracted from the vertex, see curve_shape.hpp.
///
/// sigma: the noise of each sample propagated through the fit to first order, and the remaining error of the shape:
/// curves differ from place to place, which makes an error that depends on the fraction of a step. As a share of the
/// step it grows with b, the curvature of G in steps, as b / (1 + 0.9 b), measured on four textures; summing slices to
/// bins smooths most of it away.

namespace fvd {

inline constexpr float kFloorShare = 0.9F;  ///< share of the curve's minimum that is subtracted
/// The lower neighbour has at least this share of what both must have: where a vertex lies midway between two samples,
/// 1 / (1 + b u^2)^2 leaves 0.3 of 2 / (1 + b)^2 to the third, nearly whatever b; a curve near the limit has more.
inline constexpr float kLowerNeighbour = 0.37F;
/// Beside a missing slice a neighbour lies as far out as the sample two away on the other side: the shoulder is asked
/// for this share of what it must be, where the sum of both neighbours' u is larger than kUneven.
inline constexpr float kUnevenShoulder = 0.4F;
inline constexpr float kUneven = 0.3F;
inline constexpr float kSmallestShare = 1e-3F;  ///< share of the peak that a sample at or below the floor counts as
inline constexpr float kShapeError = 0.028F;    ///< standard deviation over b / (1 + 0.9 b), in sample distances
inline constexpr float kBinnedShapeError = 0.0175F;  ///< the same where samples are bins

}  // namespace fvd
