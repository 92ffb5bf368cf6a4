#include "core/metrology/step/region_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/core/metrology/step/step_fields.hpp"

namespace fvd::metrology {
namespace {

/// Columns from..to, last included, over all rows.
Region columns(const HeightField& field, int from, int to) {
  Region region(field.width(), field.height());
  for (int row = 0; row < field.height(); ++row) {
    for (int column = from; column <= to; ++column) region.at(column, row) = 1;
  }
  return region;
}

/// 60 x 20 um; higher by `step_um` from x = 30 um on.
HeightField step_field(double step_um, double slope_x, double slope_y) {
  return make_field(120, 40, 0.5, 0.5,
                    [=](double x, double y) { return 5.0 + slope_x * x + slope_y * y + (x > 30.0 ? step_um : 0.0); });
}

constexpr std::array kSlopes{StepSlope::kCommonPlane, StepSlope::kFromLower, StepSlope::kFromUpper};

TEST(StepBetween, IsPerpendicularToThePlane) {
  HeightField field = step_field(8.0, 0.03, -0.04);
  punch_holes(field, 0.1, 31);
  const Region lower = columns(field, 0, 49);
  const Region upper = columns(field, 70, 119);

  for (const StepSlope slope : kSlopes) {
    const RegionStep step = given(step_between(field, {"land", &lower}, {"rake", &upper}, slope));

    EXPECT_NEAR(step.value.vertical_um, 8.0, 1e-11);
    EXPECT_NEAR(step.value.height_um, 8.0 / std::sqrt(1.0025), 1e-11);
    EXPECT_NEAR(step.value.slope_x, 0.03, 1e-12);
    EXPECT_NEAR(step.value.slope_y, -0.04, 1e-12);
    EXPECT_EQ(step.slope, slope);
    EXPECT_EQ(step.lower.name, "land");
    EXPECT_EQ(step.upper.asked, 50 * 40);
    EXPECT_EQ(step.value.points, step.lower.points + step.upper.points);
    EXPECT_FALSE(step.value.noise.has_value());
  }
}

TEST(StepBetween, IsNegativeWhereTheUpperLiesLower) {
  const HeightField field = step_field(-8.0, 0.0, 0.0);
  const Region lower = columns(field, 0, 49);
  const Region upper = columns(field, 70, 119);

  const RegionStep step = given(step_between(field, {"a", &lower}, {"b", &upper}, StepSlope::kCommonPlane));

  EXPECT_NEAR(step.value.height_um, -8.0, 1e-11);
}

TEST(StepBetween, IsTheSameWhicheverRegionLiesFurtherDown) {
  const HeightField field = make_field(30, 60, 0.5, 0.5, [](double, double y) { return y > 15.0 ? 8.0 : 0.0; });
  const auto rows = [&](int from, int to) {
    Region region(30, 60);
    for (int row = from; row <= to; ++row) {
      for (int column = 0; column < 30; ++column) region.at(column, row) = 1;
    }
    return region;
  };
  const Region low = rows(0, 24);
  const Region high = rows(35, 59);

  const RegionStep up = given(step_between(field, {"a", &low}, {"b", &high}, StepSlope::kFixed));
  const RegionStep down = given(step_between(field, {"a", &high}, {"b", &low}, StepSlope::kFixed));

  EXPECT_NEAR(up.value.height_um, 8.0, 1e-12);
  EXPECT_NEAR(down.value.height_um, -8.0, 1e-12);
  EXPECT_EQ(down.lower.points, 25 * 30);
  EXPECT_EQ(down.upper.points, 25 * 30);
}

TEST(StepBetween, TakesTheSlopeItIsTold) {
  // The lower region is level, the upper one rises by 0.1.
  const HeightField field =
      make_field(120, 40, 0.5, 0.5, [](double x, double) { return x > 30.0 ? 2.0 + 0.1 * x : 0.0; });
  const Region lower = columns(field, 0, 59);
  const Region upper = columns(field, 60, 119);
  const auto measure = [&](StepSlope slope) {
    return given(step_between(field, {"a", &lower}, {"b", &upper}, slope)).value;
  };

  // Centres are 30 um apart; the upper one has the mean 2 + 0.1 * 45.
  EXPECT_NEAR(measure(StepSlope::kFixed).height_um, 6.5, 1e-11);
  EXPECT_NEAR(measure(StepSlope::kFromLower).height_um, 6.5, 1e-11);
  EXPECT_NEAR(measure(StepSlope::kFromUpper).height_um, 3.5 / std::sqrt(1.01), 1e-11);
  EXPECT_NEAR(measure(StepSlope::kCommonPlane).height_um, 5.0 / std::sqrt(1.0025), 1e-11);
  EXPECT_EQ(measure(StepSlope::kFixed).slope_x, 0.0);
}

TEST(StepBetween, StatesWhatTheSlopeCosts) {
  constexpr int kLength = 600;
  struct Case {
    int gap;
    double factor;
    bool suggests;
  };
  for (const Case& expected :
       {Case{0, 2.0, false}, Case{100, 2.5166, false}, Case{200, 3.0551, true}, Case{600, 5.2915, true}}) {
    const int width = 2 * (kLength + expected.gap);
    HeightField field = make_field(width, 3, 1.0, 1.0, [](double, double) { return 0.0; });
    set_uniform_sigma(field, 1.0);
    const Region lower = columns(field, 0, kLength - 1);
    const Region upper = columns(field, width - kLength, width - 1);

    const RegionStep joint = given(step_between(field, {"a", &lower}, {"b", &upper}, StepSlope::kCommonPlane));
    const RegionStep fixed = given(step_between(field, {"a", &lower}, {"b", &upper}, StepSlope::kFixed));

    ASSERT_TRUE(joint.value.noise.has_value() && fixed.value.noise.has_value());
    EXPECT_NEAR(joint.correlation_factor, expected.factor, 5e-5) << expected.gap;
    EXPECT_NEAR(joint.value.noise->u / fixed.value.noise->u, expected.factor, 5e-5) << expected.gap;
    EXPECT_EQ(!joint.suggestion.empty(), expected.suggests) << expected.gap;
    EXPECT_EQ(fixed.correlation_factor, 1.0);
    EXPECT_NEAR(fixed.value.noise->u, std::sqrt(2.0 / (3.0 * kLength)), 1e-12);
  }
}

TEST(StepBetween, CostsMoreWithTheSlopeOfOneRegion) {
  // Distance L, slope of one region: var = 2 / n + 12 / n, and so a factor of sqrt(7).
  const HeightField field = make_field(1200, 3, 1.0, 1.0, [](double, double) { return 0.0; });
  const Region lower = columns(field, 0, 599);
  const Region upper = columns(field, 600, 1199);

  const RegionStep step = given(step_between(field, {"a", &lower}, {"b", &upper}, StepSlope::kFromLower));

  EXPECT_NEAR(step.correlation_factor, std::sqrt(7.0), 5e-5);
}

TEST(StepBetween, WeightsAreTheDerivatives) {
  HeightField field = step_field(8.0, 0.2, -0.3);
  add_white_noise(field, 0.2, 32);
  punch_holes(field, 0.1, 33);
  const Region lower = columns(field, 3, 49);
  const Region upper = columns(field, 70, 110);
  for (const StepSlope slope :
       {StepSlope::kCommonPlane, StepSlope::kFromLower, StepSlope::kFromUpper, StepSlope::kFixed}) {
    const auto measure = [&](const HeightField& changed) {
      return given(step_between(changed, {"a", &lower}, {"b", &upper}, slope)).value.height_um;
    };

    const RegionStep step = given(step_between(field, {"a", &lower}, {"b", &upper}, slope));

    expect_weights_are_derivatives(field, step.value.weights, measure, 1e-10);
  }
}

TEST(StepBetween, RefusesWhatItCannotMeasure) {
  HeightField field = step_field(8.0, 0.0, 0.0);
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 20; ++column) field.z_um.at(column, row) = kHole;
  }
  const Region left = columns(field, 0, 19);
  const Region middle = columns(field, 30, 70);
  const Region right = columns(field, 70, 119);
  const Region column_80 = columns(field, 80, 80);
  const Region column_31 = columns(field, 31, 31);
  const Region nothing(field.width(), field.height());
  const Region everything;
  const auto code = [&](const Region& lower, const Region& upper, StepSlope slope) {
    return refused(step_between(field, {"lower", &lower}, {"upper", &upper}, slope)).code;
  };

  const StepRefusal holes = refused(step_between(field, {"lower", &left}, {"upper", &right}, StepSlope::kCommonPlane));

  EXPECT_EQ(holes.code, StepRefusalCode::kTooFewValid);
  EXPECT_NEAR(holes.figure.value_or(0.0), 0.25, 1e-12);
  EXPECT_NE(holes.text.find("region lower has 200 of its 800 points"), std::string::npos) << holes.text;
  EXPECT_EQ(code(middle, right, StepSlope::kFixed), StepRefusalCode::kOverlap);
  EXPECT_EQ(code(everything, right, StepSlope::kFixed), StepRefusalCode::kOverlap);
  EXPECT_EQ(code(nothing, right, StepSlope::kFixed), StepRefusalCode::kOutside);
  EXPECT_EQ(code(nothing, nothing, StepSlope::kFixed), StepRefusalCode::kOutside);
  EXPECT_EQ(code(column_80, column_31, StepSlope::kCommonPlane), StepRefusalCode::kNoSlope);
  EXPECT_EQ(code(middle, column_80, StepSlope::kFromUpper), StepRefusalCode::kNoSlope);
}

/// Three stairs of 20 um each at 0, 4 and 9 um, tilted.
HeightField stairs() {
  return make_field(120, 40, 0.5, 0.5, [](double x, double y) {
    const std::array<double, 3> level{0.0, 4.0, 9.0};
    return level.at(static_cast<std::size_t>(x / 20.0)) + 0.02 * x + 0.01 * y;
  });
}

TEST(Levels, GiveAllDifferencesOnOnePlane) {
  HeightField field = stairs();
  set_uniform_sigma(field, 0.1);
  const std::array regions{columns(field, 2, 37), columns(field, 42, 77), columns(field, 82, 117)};

  const Levels found = given(levels(field, {{"A", &regions[0]}, {"B", &regions[1]}, {"C", &regions[2]}}));

  ASSERT_EQ(found.differences.size(), 3U);
  ASSERT_EQ(found.regions.size(), 3U);
  const std::array<std::array<int, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  const std::array<double, 3> expected{4.0, 9.0, 5.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.differences[i].lower, pairs.at(i)[0]);
    EXPECT_EQ(found.differences[i].upper, pairs.at(i)[1]);
    EXPECT_NEAR(found.differences[i].value.vertical_um, expected.at(i), 1e-11);
    EXPECT_NEAR(found.differences[i].value.height_um, expected.at(i) / std::sqrt(1.0005), 1e-11);
    EXPECT_TRUE(found.differences[i].value.noise.has_value());
  }
  EXPECT_NEAR(found.slope_x, 0.02, 1e-12);
  EXPECT_NEAR(found.slope_y, 0.01, 1e-12);
  EXPECT_EQ(found.regions[2].name, "C");
  // 1 + D^2 / 3 over twice the mean square of 36 columns about their middle; D = 40 and 80 columns.
  const double spread = 3.0 * (36.0 * 36.0 - 1.0) / 12.0;
  EXPECT_NEAR(found.differences[0].correlation_factor, std::sqrt(1.0 + 1600.0 / (2.0 * spread)), 1e-9);
  EXPECT_NEAR(found.differences[1].correlation_factor, std::sqrt(1.0 + 6400.0 / (2.0 * spread)), 1e-9);
}

TEST(Levels, WeightsAreTheDerivatives) {
  HeightField field = stairs();
  add_white_noise(field, 0.2, 34);
  const std::array regions{columns(field, 2, 37), columns(field, 42, 77), columns(field, 82, 117)};
  const std::vector<NamedRegion> named{{"A", &regions[0]}, {"B", &regions[1]}, {"C", &regions[2]}};

  const Levels found = given(levels(field, named));

  expect_weights_are_derivatives(
      field, found.differences[0].value.weights,
      [&](const HeightField& changed) { return given(levels(changed, named)).differences[0].value.height_um; }, 1e-10);
}

TEST(Levels, TakeTwoToTwoHundredRegions) {
  const HeightField field = stairs();
  const Region region = columns(field, 2, 37);

  EXPECT_THROW((void)levels(field, {{"A", &region}}), Error);
  EXPECT_THROW((void)levels(field, std::vector<NamedRegion>(201, {"A", &region})), Error);
  EXPECT_EQ(refused(levels(field, {{"A", &region}, {"B", &region}})).code, StepRefusalCode::kOverlap);
}

TEST(StepRefusal, HasAStableName) {
  EXPECT_STREQ(step_refusal_name(StepRefusalCode::kTooFewValid), "too_few_valid");
  EXPECT_STREQ(step_refusal_name(StepRefusalCode::kNoEdges), "no_edges");
  EXPECT_STREQ(step_refusal_name(StepRefusalCode::kTooFewTraces), "too_few_traces");
  EXPECT_STREQ(step_refusal_name(StepRefusalCode::kOutside), "outside");
  EXPECT_STREQ(step_refusal_name(StepRefusalCode::kOverlap), "overlap");
  EXPECT_STREQ(step_refusal_name(StepRefusalCode::kNoSlope), "no_slope");
  EXPECT_STREQ(step_refusal_name(StepRefusalCode::kNotRounded), "not_rounded");
}

}  // namespace
}  // namespace fvd::metrology
