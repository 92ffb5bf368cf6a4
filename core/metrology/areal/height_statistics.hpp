#pragma once

/// What the heights of a region are like as a whole: made once for its parameters and for their noise.

#include <vector>

#include "core/metrology/areal/height_moments.hpp"
#include "core/metrology/areal/region_heights.hpp"
#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

/// Zeros where the region has no valid point.
struct HeightStatistics {
  RegionSurvey survey;
  double mean_um = 0.0;
  double mean_sign = 0.0;  ///< share of points above the mean, less the share below it
  HeightMoments moments;   ///< about the mean
};

/// region: empty or of the field's shape. heights_um: receives the valid heights about their mean, row by row.
[[nodiscard]] HeightStatistics height_statistics(const HeightField& field, const Region& region,
                                                 std::vector<double>& heights_um);

}  // namespace fvd::metrology
