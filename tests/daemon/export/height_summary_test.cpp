#include "daemon/export/height_summary.hpp"

#include <gtest/gtest.h>

#include "tests/daemon/export/sample_result.hpp"

namespace fvd {
namespace {

constexpr double kFloatUm = 1e-5;  // what float32 metres can tell apart at these heights

TEST(HeightSummary, DescribesTheValidPoints) {
  HeightMap map = test::sample_map(5, 1);  // 0 1 2 3 4 um
  test::make_hole(map, 0, 0, mask_reason::kLowProminence);
  const HeightSummary summary = summarize_heights(map);
  EXPECT_EQ(summary.points, 5U);
  EXPECT_EQ(summary.valid, 4U);
  EXPECT_DOUBLE_EQ(summary.valid_fraction(), 0.8);
  ASSERT_TRUE(summary.height);
  EXPECT_NEAR(summary.height->min_um, 1.0, kFloatUm);
  EXPECT_NEAR(summary.height->max_um, 4.0, kFloatUm);
  EXPECT_NEAR(summary.height->mean_um, 2.5, kFloatUm);
  EXPECT_NEAR(summary.height->median_um, 2.5, kFloatUm) << "the mean of the two middle ones";
}

TEST(HeightSummary, TakesTheMiddleOneOfAnOddNumber) {
  EXPECT_NEAR(summarize_heights(test::sample_map(5, 1)).height->median_um, 2.0, kFloatUm);
}

TEST(HeightSummary, CountsAPointWithTwoReasonsTwice) {
  HeightMap map = test::sample_map();
  test::make_hole(map, 0, 0, mask_reason::kFirstSlice | mask_reason::kSaturated);
  test::make_hole(map, 1, 0, mask_reason::kLastSlice);
  test::make_hole(map, 2, 0, mask_reason::kNotBracketed);
  test::make_hole(map, 3, 0, mask_reason::kLowProminence);
  const HeightSummary summary = summarize_heights(map);
  EXPECT_EQ(summary.holes.first_slice, 1U);
  EXPECT_EQ(summary.holes.saturated, 1U);
  EXPECT_EQ(summary.holes.last_slice, 1U);
  EXPECT_EQ(summary.holes.not_bracketed, 1U);
  EXPECT_EQ(summary.holes.low_prominence, 1U);
  EXPECT_EQ(summary.valid, 14U);
}

TEST(HeightSummary, HasNoHeightsWhereAllPointsAreHoles) {
  HeightMap map = test::sample_map(1, 1);
  test::make_hole(map, 0, 0, mask_reason::kLowProminence);
  const HeightSummary summary = summarize_heights(map);
  EXPECT_FALSE(summary.height);
  EXPECT_EQ(summary.valid_fraction(), 0.0);
}

TEST(HeightSummary, KeepsOutliersOutOfTheRobustLimits) {
  HeightMap map = test::sample_map(100, 20);
  for (float& z : map.height_m.pixels()) z = 5e-6F;
  map.height_m.at(0, 0) = -1.0F;
  map.height_m.at(1, 0) = 1.0F;
  const auto height = summarize_heights(map).height;
  EXPECT_NEAR(height->low_um, 5.0, kFloatUm);
  EXPECT_NEAR(height->high_um, 5.0, kFloatUm);
  EXPECT_NEAR(height->max_um, 1e6, 1e-3);
}

}  // namespace
}  // namespace fvd
