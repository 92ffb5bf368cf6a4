#pragma once

/// Slopes of a surface: Sdq and Sdr.

#include <optional>

#include "core/metrology/areal/region_heights.hpp"

namespace fvd::metrology {

/// Sdq, ISO 25178-2:2021: root mean square gradient. Slopes by central differences: of 7 points (order 6) where the
/// three neighbours on both sides are valid, else of 5 points (order 4), else of 3 (order 2), for x and y each. A point
/// without valid neighbours on both sides in x and in y is left out. Absent where no point is left.
[[nodiscard]] std::optional<double> root_mean_square_gradient(const RegionHeights& heights);

/// Sdr in percent, ISO 25178-2:2021: the surface's area over the projected area, minus 1. A cell between four points is
/// two triangles; the two ways to cut it are averaged. A cell with a hole is left out. Absent where no cell is left.
[[nodiscard]] std::optional<double> developed_area_ratio_percent(const RegionHeights& heights);

}  // namespace fvd::metrology
