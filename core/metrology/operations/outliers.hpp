#pragma once

/// Removal of points that do not belong to their neighbourhood.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/runtime/worker_pool.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd::metrology {

struct OutlierSettings {
  int window_px = 7;   ///< odd, 3 to 31
  double limit = 6.0;  ///< > 0, in units of the larger of 1.4826 x MAD and the point's standard error
};

/// Makes a hole, with reason kOutlier, of every point with |z - m| > limit * max(1.4826 * MAD, sigma): m is the median
/// of the valid points of the window around it, MAD the median of their distances from m; both are the mean of the two
/// middle ones where the number is even. At the image's border the window is cut off. All windows see the surface as it
/// was. Own definition; 1.4826 makes of the MAD of a normal distribution its standard deviation.
///
/// Decides nothing: a window with under half of its points valid, and one whose MAD and sigma are both 0 (over half of
/// its heights are the same number, so that it has no scale). Values: window_px, limit, undecided_few_valid,
/// undecided_no_scale (points that differ from the median of such a window; with a warning).
/// Throws Error(kBadRecipe) on settings out of range. pool: shares out rows where given; the result is the same with
/// any number of threads. context: pure.
[[nodiscard]] OperationReport remove_outliers(HeightField& field, const OutlierSettings& settings,
                                              Plane<MaskReasons>* reasons = nullptr, WorkerPool* pool = nullptr);

}  // namespace fvd::metrology
