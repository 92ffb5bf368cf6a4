#pragma once

/// The valid points of a region, cut out of their field.

#include <cstddef>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/region_bounds.hpp"

namespace fvd::metrology {

/// The smallest rectangle around the region's valid points, with a margin of holes on every side, so that what looks at
/// neighbours needs no rule for borders: points outside the region are holes.
struct RegionHeights {
  static constexpr int kMargin = 3;

  Plane<double> z_um;  ///< [height + 2 kMargin][width + 2 kMargin], as measured; NaN = hole; empty without valid points
  int width = 0;       ///< without the margins
  int height = 0;
  double pitch_x_um = 1.0;
  double pitch_y_um = 1.0;
  std::size_t points = 0;         ///< valid points
  std::size_t region_points = 0;  ///< points of the region, holes included

  /// The first of width heights of a row of the rectangle; row from -kMargin to height + kMargin - 1.
  [[nodiscard]] const double* row(int row) const { return z_um.row(row + kMargin) + kMargin; }
};

/// How many points a region has, and the rectangle that the valid ones take.
struct RegionSurvey {
  RegionBounds valid;             ///< without valid points {0, 0, 0, 0}
  std::size_t points = 0;         ///< valid points
  std::size_t region_points = 0;  ///< points of the region, holes included
};

/// region: empty or of the field's shape, as in the next two.
[[nodiscard]] RegionSurvey survey_region(const HeightField& field, const Region& region);

/// Row by row. survey: of the same field and region.
[[nodiscard]] std::vector<double> valid_heights_um(const HeightField& field, const Region& region,
                                                   const RegionSurvey& survey);

[[nodiscard]] RegionHeights cut_region(const HeightField& field, const Region& region);

}  // namespace fvd::metrology
