/// Steps between regions, and stairs.

#include <cmath>

#include <gtest/gtest.h>

#include "core/metrology/step/region_step.hpp"
#include "tests/core/metrology/step/made_field.hpp"

namespace fvd::metrology {
namespace {

using test::made_field;

/// Columns from first to end, all rows.
Region columns(int first, int end) {
  Region region(300, 40, 0);
  for (int row = 0; row < 40; ++row) {
    for (int column = first; column < end; ++column) region.at(column, row) = 1;
  }
  return region;
}

HeightField stair() {
  return made_field(300, 40, [](double x, double y) { return 0.02 * x - 0.01 * y + (x > 150.0 ? 20.0 : 0.0); });
}

RegionStep step_with_gap(int gap, StepSlope slope = StepSlope::kCommonPlane) {
  const Region lower = columns(30 - gap, 150 - gap);
  const Region upper = columns(150 + gap, 270 + gap);
  return std::get<RegionStep>(step_between(stair(), {"lower", &lower}, {"upper", &upper}, slope));
}

TEST(AStepBetweenRegions, IsThatOfThePlanes) {
  for (const StepSlope slope : {StepSlope::kCommonPlane, StepSlope::kFromLower, StepSlope::kFromUpper}) {
    const RegionStep step = step_with_gap(10, slope);

    EXPECT_NEAR(step.value.vertical_um, 20.0, 1e-9);
    EXPECT_NEAR(step.value.height_um, 20.0 / std::sqrt(1.0005), 1e-9);
  }
  EXPECT_GT(step_with_gap(10, StepSlope::kFixed).value.vertical_um, 22.0) << "the tilt is not taken off";
}

TEST(AStepBetweenRegions, TellsHowMuchTheSlopeCosts) {
  EXPECT_NEAR(step_with_gap(0).correlation_factor, 2.0, 0.001);
  EXPECT_NEAR(step_with_gap(20).correlation_factor, 2.5166, 0.001);
  EXPECT_TRUE(step_with_gap(20).suggestion.empty());
  const RegionStep wide = step_with_gap(30);
  EXPECT_NEAR(wide.correlation_factor, std::sqrt(1.0 + 12.0 * 180.0 * 180.0 / (4.0 * 120.0 * 120.0)), 0.01);
  EXPECT_FALSE(step_with_gap(29).suggestion.empty() && step_with_gap(29).correlation_factor > 3.0);
}

TEST(AStepBetweenRegions, IsRefusedWhereTheyShareOrLackPoints) {
  const Region lower = columns(0, 151);
  const Region upper = columns(150, 300);
  const auto shared = step_between(stair(), {"lower", &lower}, {"upper", &upper}, StepSlope::kCommonPlane);
  EXPECT_EQ(std::get<StepRefusal>(shared).code, StepRefusalCode::kOverlap);

  const Region none = columns(0, 0);
  const auto empty = step_between(stair(), {"lower", &none}, {"upper", &upper}, StepSlope::kCommonPlane);
  EXPECT_EQ(std::get<StepRefusal>(empty).code, StepRefusalCode::kOutside);

  HeightField holes = stair();
  for (int row = 0; row < 40; ++row) {
    for (int column = 150; column < 200; ++column) holes.z_um.at(column, row) = std::nan("");
  }
  const Region left = columns(0, 150);
  const auto few = step_between(holes, {"lower", &left}, {"upper", &upper}, StepSlope::kCommonPlane);
  EXPECT_EQ(std::get<StepRefusal>(few).code, StepRefusalCode::kTooFewValid);
  EXPECT_NEAR(std::get<StepRefusal>(few).figure.value(), 2.0 / 3.0, 1e-9);
}

TEST(Stairs, HaveEveryDifference) {
  const HeightField field =
      made_field(300, 40, [](double x, double) { return 0.05 * x + 10.0 * std::floor(x / 100.0); });
  const Region a = columns(0, 100);
  const Region b = columns(100, 200);
  const Region c = columns(200, 300);

  const Levels found = std::get<Levels>(levels(field, {{"a", &a}, {"b", &b}, {"c", &c}}));

  ASSERT_EQ(found.differences.size(), 3U);
  EXPECT_NEAR(found.differences[0].value.vertical_um, 10.0, 1e-9);
  EXPECT_NEAR(found.differences[1].value.vertical_um, 20.0, 1e-9);
  EXPECT_NEAR(found.differences[2].value.vertical_um, 10.0, 1e-9);
  EXPECT_NEAR(found.slope_x, 0.05, 1e-12);
}

}  // namespace
}  // namespace fvd::metrology
