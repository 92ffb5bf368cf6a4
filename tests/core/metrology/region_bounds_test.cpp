#include "core/metrology/region_bounds.hpp"

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

TEST(RegionBounds, AreThoseOfTheOutermostPoints) {
  for (int left = 0; left < 21; ++left) {
    for (int right = left; right < 21; ++right) {
      Region region(21, 5);
      region.at(left, 3) = 1;
      region.at(right, 1) = 255;

      const RegionBounds bounds = bounds_of(region, 21, 5);

      EXPECT_EQ(bounds, (RegionBounds{left, 1, right + 1, 4}));
    }
  }
}

TEST(RegionBounds, OfAnEmptyRegionAreTheField) { EXPECT_EQ(bounds_of({}, 7, 4), (RegionBounds{0, 0, 7, 4})); }

TEST(RegionBounds, WithoutAPointAreEmpty) {
  const RegionBounds bounds = bounds_of(Region(30, 4), 30, 4);

  EXPECT_TRUE(bounds.empty());
  EXPECT_EQ(bounds, RegionBounds{});
}

}  // namespace
}  // namespace fvd::metrology
