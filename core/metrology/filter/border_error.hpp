#pragma once

/// What a cut kernel does to a sloping or bent surface.

#include "core/metrology/filter/filter_settings.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

struct GeneralShape {
  double slope = 0.0;             ///< the largest inside the field
  double curvature_per_um = 0.0;  ///< the largest, second derivative in the steepest direction
};

/// Of the least squares paraboloid through the valid points (every n-th of large fields); of the points what they
/// determine.
[[nodiscard]] GeneralShape general_shape(const Plane<double>& z_um, double pitch_x_um, double pitch_y_um);

/// See FilterReport::border_error_um. smallest_share: of the kernel's weight on valid points, beside any point given.
[[nodiscard]] double border_error_um(FilterMethod method, double nesting_um, const GeneralShape& shape,
                                     double smallest_share);

}  // namespace fvd::metrology
