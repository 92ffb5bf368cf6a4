#pragma once

/// Levelling: a plane is fitted along z and subtracted.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

enum class LevelMethod {
  kLeastSquares,
  kWeighted,  ///< least squares with weights 1 / sigma^2; refused without sigma
  kRobust,    ///< Tukey weights, after a start that a minority of foreign points cannot spoil
};

/// Subtracts z = offset_um + slope_x * x + slope_y * y, fitted to the valid points of the region, from every point. x,
/// y in um from the outer corner of pixel (0, 0). Values: offset_um, slope_x, slope_y; kRobust also `cut_um`, `rounds`,
/// `share_without_weight`.
///
/// kRobust, own definition after ISO 16610-31: weights (1 - (r / cut)^2)^2, cut = 4.4478 x median of |r|, repeated
/// until no point of the field moves by more than 1e-13 of its heights' scale or of 1e-10 of the cut, 40 rounds at
/// most; a warning says where the last change is above 1e-4 of the cut. Starts from the best of fixed planes through
/// three points by the median of |r|, so up to about 40 % of foreign points do not matter. Standard errors: from the
/// scatter of the residuals (kWeighted: from sigma, enlarged where the scatter is larger), with errors of neighbouring
/// points correlated by the field's kernel: enlarged by its width in pixels. Refused where the region has under three
/// points or all of them on one line. context: pure.
[[nodiscard]] OperationReport level(HeightField& field, LevelMethod method, const Region& region,
                                    WorkerPool* pool = nullptr);

}  // namespace fvd::metrology
