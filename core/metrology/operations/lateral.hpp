#pragma once

/// The lateral calibration, put to use.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd::metrology {

/// The point of column i and row j stands at y = (j + 0.5) * pitch_y_um and x = (i + 0.5) * pitch_x_um + shear * y.
/// Own definition.
struct LateralCalibration {
  double pitch_x_um = 1.0;  ///< > 0
  double pitch_y_um = 1.0;  ///< > 0
  double shear = 0.0;       ///< tangent of the angle by which the image's y axis leans towards x; |shear| < 0.1
};

inline constexpr double kLargestShearLeft = 1e-4;  ///< up to it points stay where they are

/// Sets the pitch, and where |shear| > kLargestShearLeft puts the surface on a grid of right angles of the same size
/// and pitch: each height is the linear mean of its two neighbours in the row (shear moves points along x only). A
/// missing neighbour makes a hole, with its reasons or, beyond the border, kOutOfView; a neighbour of weight zero is
/// not missing. sigma is averaged with the same weights, which is its upper bound whatever the correlation.
/// Values: pitch_x_um, pitch_y_um, shear, resampled (0, 1), shift_left_um (largest displacement that was not undone).
/// Throws Error(kBadInput) on a calibration out of range. context: pure.
[[nodiscard]] OperationReport lateral(HeightField& field, const LateralCalibration& calibration,
                                      Plane<MaskReasons>* reasons = nullptr);

}  // namespace fvd::metrology
