#pragma once

/// Spheres, cylinders and cones in numbers for people.

#include <vector>

#include "core/metrology/operations/operation_report.hpp"
#include "core/metrology/operations/round_fit.hpp"

namespace fvd::metrology {

/// As remove_form() lists them, without side and rms; standard errors are enlarged by kernel_width_px. context: pure.
[[nodiscard]] std::vector<NamedValue> round_values(RoundKind kind, const RoundFit& fit, double kernel_width_px);

}  // namespace fvd::metrology
