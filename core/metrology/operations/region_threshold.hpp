#pragma once

/// Regions by height.

#include <cstddef>
#include <optional>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

struct ThresholdSettings {
  std::optional<double> above_um;  ///< z >= above_um
  std::optional<double> below_um;  ///< z <= below_um
  bool largest = false;            ///< only the connected part with the most points
};

struct ThresholdRegion {
  Region region;
  std::size_t points = 0;  ///< in the region
  std::size_t parts = 0;   ///< connected parts before `largest`; points are connected to their four neighbours
  bool tie = false;        ///< several parts have the most points; the one that begins first in reading order was taken
};

/// Holes belong to no region and connect nothing. Throws Error(kBadRecipe) without a bound, on bounds that are not
/// finite or cross. context: pure.
[[nodiscard]] ThresholdRegion threshold_region(const HeightField& field, const ThresholdSettings& settings);

}  // namespace fvd::metrology
