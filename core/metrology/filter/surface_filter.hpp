#pragma once

/// Gaussian filters of surfaces with holes: mean, local plane, local paraboloid; each also robust.

#include "core/metrology/filter/filter_settings.hpp"
#include "core/metrology/height_field.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

struct FilteredSurface {
  HeightField surface;  ///< of the same size and pitch; a hole wherever the field had one, and where points were lost
  FilterReport report;
};

/// Smooth surface (S) or field minus smooth surface (L), by ISO 16610-61 and -71 (see FilterMethod).
///
/// Holes stay holes; weights lie on valid points alone, so that nothing is interpolated. The local plane and paraboloid
/// reproduce planes and paraboloids up to any border. A point is lost (a hole) where under kMinWeightShare or
/// kMinRegressionWeightShare of the kernel's weight lies on valid points, or where those do not determine the
/// polynomial. Robust: rounds with Tukey weights (1 - (r / cut)^2)^2; a point around which all weight went is lost as
/// well.
///
/// sigma_um and kernel: S propagates them as those of a Gaussian of this nesting index, for any method (a local
/// paraboloid's noise is 2 % above that inside, more at borders); L keeps both, for it takes little noise away.
///
/// Throws Error(kBadInput) where nesting_um is under kMinNestingPx pixels in x or y (the message tells the figure),
/// above 1e6 pixels, or not a number; or where the field is empty.
/// pool: shares out the work; the result is the same for any number of threads. context: pure.
[[nodiscard]] FilteredSurface filter_surface(const HeightField& field, const FilterSettings& settings,
                                             WorkerPool* pool = nullptr);

}  // namespace fvd::metrology
