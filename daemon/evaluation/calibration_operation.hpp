#pragma once

/// The constants of the instrument, put to use on a surface.

#include <string>

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/surface/mask_reason.hpp"
#include "daemon/evaluation/evaluation_context.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// alpha_z of the calibration; 1 where it has no constants of z.
[[nodiscard]] double z_amplification(const EvaluationContext& context) noexcept;

/// Divides heights and standard errors by alpha_z. context: pure, as the next ones.
void divide_heights(double alpha_z, metrology::HeightField& field);

/// What the operation needs of the calibration and is not there, and what to do; empty where nothing is missing.
[[nodiscard]] std::string missing_calibration(const PlannedOperation& step, const EvaluationContext& context);

/// `lateral` and `flatness_reference`, for which missing_calibration() found nothing. reasons: null, or of the shape of
/// the field. The surface is unchanged where the report has a refusal.
[[nodiscard]] metrology::OperationReport lateral_operation(const EvaluationContext& context,
                                                           Plane<MaskReasons>* reasons, metrology::HeightField& field);
[[nodiscard]] metrology::OperationReport flatness_operation(const EvaluationContext& context,
                                                            Plane<MaskReasons>* reasons, metrology::HeightField& field);

}  // namespace fvd
