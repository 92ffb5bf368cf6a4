#pragma once

/// Standard errors of the points of a filtered surface.

#include "core/metrology/filter/filter_settings.hpp"
#include "core/metrology/height_field.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

/// Sets result.sigma_um (where field has it) and result.kernel. L keeps both. S: errors are white noise averaged by
/// field.kernel; so the smooth surface averages that noise by the kernel convolved with the Gaussian, and its variance
/// is the mean of sigma^2 by the square of that, times the ratio of their sums of squares, over the square of the share
/// of valid weight. The kernel of the result is the convolved one, in x; pitches that differ much are not told by it.
/// Own definition. share: of the Gaussian on valid points. result.z_um is set.
void carry_noise(const HeightField& field, const FilterSettings& settings, const Plane<double>& share, WorkerPool* pool,
                 HeightField& result);

}  // namespace fvd::metrology
