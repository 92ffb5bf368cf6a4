#pragma once

/// Regions from regions.

#include "core/metrology/operations/region.hpp"

namespace fvd::metrology {

/// All regions of one grid; none is the empty plane that stands for every point. context: pure.
[[nodiscard]] Region region_not(const Region& region);
[[nodiscard]] Region region_union(const Region& left, const Region& right);
[[nodiscard]] Region region_intersection(const Region& left, const Region& right);

/// Keeps the points whose centre is farther than shrink_um from the centre of every point outside of the region. What
/// lies beyond the image does not count as outside: a region that the image cuts off does not shrink there.
/// shrink_um >= 0, else Error(kBadRecipe). context: pure.
[[nodiscard]] Region region_shrink(const Grid& grid, const Region& region, double shrink_um);

}  // namespace fvd::metrology
