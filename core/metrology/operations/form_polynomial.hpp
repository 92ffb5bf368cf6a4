#pragma once

/// A polynomial surface, fitted along z.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/chosen_points.hpp"
#include "core/metrology/operations/operation_report.hpp"

namespace fvd::metrology {

/// Fits and subtracts as remove_form() describes; degree 1 to 6. Solved in Chebyshev polynomials, which stay nearly
/// independent of each other where monomials do not. context: pure.
[[nodiscard]] OperationReport remove_polynomial(HeightField& field, const ChosenPoints& points, int degree);

}  // namespace fvd::metrology
