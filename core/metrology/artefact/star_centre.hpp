#pragma once

/// Centre, number of sectors and phase of a Siemens star.

#include <optional>

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/region.hpp"

namespace fvd::metrology {

/// A star whose sectors' middles lie where cos(pairs * azimuth - phase) is 1.
struct StarLayout {
  PointUm centre;
  int pairs = 0;
  double phase = 0.0;
  double radius_um = 0.0;  ///< of the rim, or of the farthest ring in the field
};

/// What is known of a star beforehand.
struct StarHints {
  std::optional<int> pairs;
  std::optional<PointUm> centre;
};

/// shares: of the way from the lower to the upper level, of the field's shape. The centre is where the edges of sectors
/// point, then where the waves of all rings have one phase; the number of pairs is that of the strongest wave around
/// it. Absent where no star shows. context: pure.
[[nodiscard]] std::optional<StarLayout> find_star(const HeightField& field, const Plane<float>& shares,
                                                  const StarHints& hints);

}  // namespace fvd::metrology
