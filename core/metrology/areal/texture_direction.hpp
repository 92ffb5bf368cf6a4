#pragma once

/// The direction of a texture: Std.

#include "core/metrology/areal/areal_parameters.hpp"
#include "core/metrology/areal/region_heights.hpp"

namespace fvd::metrology {

/// Std in degrees, 0 <= Std < 180: the direction s of the lay, which is across the waves (sin s, cos s) of greatest
/// power, ISO 25178-2:2021 (angular power spectrum); counter-clockwise from x as the surface is seen, with y down. Own
/// definition of the spectrum: heights about their weighted mean, holes as 0, Hann window over the region's rectangle;
/// the power of a bin is spread over the angle that the bin takes as seen from 0, in steps of half a degree;
/// frequencies up to the smaller Nyquist frequency. The value is across the mean frequency of the waves in the greatest
/// peak, which is right for a single wave wherever it lies between bins. tie: another peak is as great to 1e-6; the
/// least angle is taken. Absent, with a reason, below 8 columns or rows, without any power, and where no direction has
/// twice the mean power of all, as on a surface without a lay.
[[nodiscard]] ArealValue texture_direction_deg(const RegionHeights& heights);

}  // namespace fvd::metrology
