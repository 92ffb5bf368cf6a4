#pragma once

/// Operations that move, turn over or cut a surface, and the correction by a reference surface.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/metrology/operations/region.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd::metrology {

/// Keeps the smallest block of pixels whose centres lie in the rectangle; its outer corner becomes (0, 0). Values:
/// first_column, first_row, columns, rows. Refused where no centre lies in it. context: pure.
[[nodiscard]] OperationReport crop(HeightField& field, const RectangleUm& rectangle,
                                   Plane<MaskReasons>* reasons = nullptr);

/// Adds shift_um to every height. Value: shift_um. context: pure.
[[nodiscard]] OperationReport shift_z(HeightField& field, double shift_um);

/// Heights change their sign; x and y stay. context: pure.
[[nodiscard]] OperationReport invert(HeightField& field);

/// Subtracts the reference, e.g. the heights that the instrument shows of a perfect flat. The standard errors add as
/// squares. Where the reference has a hole the point becomes one, with reason kMaxSigma: its error is not known.
/// Refused where sizes differ, or pitches by more than 1e-6. A warning where only one of both has sigma. context: pure.
[[nodiscard]] OperationReport flatness_reference(HeightField& field, const HeightField& reference,
                                                 Plane<MaskReasons>* reasons = nullptr);

}  // namespace fvd::metrology
