#pragma once

/// Operations that take points out of a surface for what is known about them.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/runtime/worker_pool.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd::metrology {

/// Makes a hole of one point: height and standard error become NaN, and the reasons gain `reason` where there is a
/// plane of them. reasons: null, or of the shape of the field.
void make_hole(HeightField& field, int column, int row, Plane<MaskReasons>* reasons, MaskReasons reason);

/// Makes holes of the points whose standard error is larger than max_sigma_um (> 0), with reason kMaxSigma.
/// Refused where the field has no sigma. pool: may be null. context: pure.
[[nodiscard]] OperationReport mask_sigma(HeightField& field, double max_sigma_um, Plane<MaskReasons>* reasons = nullptr,
                                         WorkerPool* pool = nullptr);

/// Makes holes of the points that carry one of the reasons in `bits`; of the shape of the field, or it is refused.
/// context: pure.
[[nodiscard]] OperationReport mask_reasons(HeightField& field, const Plane<MaskReasons>& reasons, MaskReasons bits);

}  // namespace fvd::metrology
