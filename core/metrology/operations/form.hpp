#pragma once

/// Removal of a nominal form (F-operation of ISO 25178-2:2021, 3.1.6), fitted by orthogonal distances.

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/operation_report.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd::metrology {

enum class FormKind { kPlane, kPolynomial, kSphere, kCylinder, kCone };

struct FormSettings {
  FormKind kind = FormKind::kPlane;
  int degree = 2;  ///< of a polynomial, 1 to 6: all terms x^p y^q with p + q <= degree
};

/// Fits the form to the valid points of the region and subtracts it along z everywhere. Plane, sphere, cylinder, cone:
/// least squares of the distances at right angles to the form; polynomial: least squares along z. Where a sphere,
/// cylinder or cone has no height above a point, the point becomes a hole with reason kOutlier.
///
/// Values, x y z in um from the outer corner of pixel (0, 0) and zero height, angles in degrees:
/// plane       offset_um, slope_x, slope_y
/// polynomial  c_pq_um for all p, q: z = sum of c_pq X^p Y^q, X and Y from -1 to 1 over the smallest block of
///             pixels that holds the points used: X = (x - centre_x_um) / half_x_um, Y alike, which are given as well
/// sphere      radius_um, centre_x_um, centre_y_um, centre_z_um, side (1: the surface is the upper side, a bump; -1: a
///             bowl)
/// cylinder    radius_um, axis_x_um, axis_y_um, axis_z_um (the axis' point nearest to the middle of the points),
///             azimuth_deg (of the axis in the image, -90 < a <= 90, from x towards y; absent of an upright axis),
///             elevation_deg (of the axis from the image's plane, positive where z rises along the azimuth), side
/// cone        as cylinder, radius_um at that point, and taper_deg: half of the opening angle, positive where the
///             radius grows along the axis in the direction of azimuth and elevation; apex_x_um, apex_y_um, apex_z_um
///             where |taper_deg| > 0.001
/// then        rms_um: root of the mean square distance.
/// Standard errors as those of level(); absent for side and apex. Refused: too few points for the parameters, points
/// that do not determine the form, or a fit that does not settle in 60 rounds. Throws Error(kBadRecipe) on a degree out
/// of range. reasons: null or of the shape of the field. context: pure.
[[nodiscard]] OperationReport remove_form(HeightField& field, const FormSettings& settings, const Region& region,
                                          Plane<MaskReasons>* reasons = nullptr);

}  // namespace fvd::metrology
