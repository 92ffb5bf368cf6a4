#pragma once

/// How far the samples of a scan's focus curves lie beside the curves that are laid through them, beyond what the
/// image's noise explains.
///
/// Texture that is not fine against the window, compression, a lens that is not quite symmetric: curves differ in shape
/// from place to place, and that moves their vertices as noise does, with no noise in the image. Five samples and three
/// unknowns leave two residuals a point. A point's own are too few to judge it by; those of the whole scan tell a
/// figure that its points have in common, relative to the height of their curves.

#include <span>
#include <vector>

#include "core/focus/fit/curve_tuple.hpp"

namespace fvd {

/// Standard deviation that a sample has beside its noise, as a share of its curve's amplitude; 0 where the noise
/// explains all or fewer than 100 curves have all five samples. Tuples: spread over the image, their indices within
/// z_um. exponent: that of the scan's curves, see curve_shape.hpp.
[[nodiscard]] double curve_misfit(std::span<const CurveTuple> tuples, const std::vector<double>& z_um, double exponent);

}  // namespace fvd
