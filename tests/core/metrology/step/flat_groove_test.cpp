#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "tests/core/metrology/step/step_fields.hpp"

namespace fvd::metrology {
namespace {

constexpr double kWidth = 90.0;
constexpr double kCentre = 150.0;

/// A groove along y of width 90, in the middle of 300 um; depth < 0 is a ridge.
HeightField groove(double depth_um, double slope_x, double slope_y, int rows = 90) {
  return make_field(300, rows, 1.0, 1.0, [=](double x, double y) {
    return 3.0 + slope_x * x + slope_y * y - (std::abs(x - kCentre) < kWidth / 2.0 ? depth_um : 0.0);
  });
}

GrooveSettings with_edges() {
  GrooveSettings settings;
  settings.edges = GrooveEdges{kCentre - kWidth / 2.0, kCentre + kWidth / 2.0};
  return settings;
}

TEST(FlatGroove, IsExactOnATiltedGrooveWithHoles) {
  HeightField field = groove(50.0, 0.02, 0.01);
  punch_holes(field, 0.1, 1);

  const GrooveStep step = given(iso5436_a1(field, {}));

  EXPECT_EQ(step.sign, GrooveSign::kGroove);
  EXPECT_FALSE(step.edges_given);
  // Holes let other rows of the tilted band be the median.
  EXPECT_NEAR(step.edges.left_um, 105.0, 1e-3);
  EXPECT_NEAR(step.edges.right_um, 195.0, 1e-3);
  EXPECT_NEAR(step.areal.vertical_um, 50.0, 1e-9);
  EXPECT_NEAR(step.areal.height_um, 50.0 / std::sqrt(1.0005), 1e-9);
  EXPECT_NEAR(step.areal.slope_x, 0.02, 1e-12);
  EXPECT_NEAR(step.areal.slope_y, 0.01, 1e-12);
  EXPECT_NEAR(step.mean.vertical_um, 50.0, 1e-9);
  EXPECT_NEAR(step.mean.height_um, 50.0 / std::sqrt(1.0004), 1e-9);
  ASSERT_EQ(step.traces.each.size(), 9U);
  for (const StepTrace& trace : step.traces.each) {
    EXPECT_NEAR(trace.height_um, 50.0 / std::sqrt(1.0004), 1e-9);
    EXPECT_NEAR(trace.slope, 0.02, 1e-11);
  }
  EXPECT_LT(step.traces.sd_um, 1e-9);
  // Holes are what makes plain means wrong on a tilted surface.
  EXPECT_GT(std::abs(step.plain_means_um - 50.0), 1e-4);
  EXPECT_NEAR(step.plain_means_um, 50.0, 0.1);
}

TEST(FlatGroove, HasTheRegionsOfTheStandard) {
  const auto regions = groove_regions({105.0, 195.0});

  EXPECT_NEAR(regions[0].from_um, 15.0, 1e-12);
  EXPECT_NEAR(regions[0].to_um, 75.0, 1e-12);
  EXPECT_NEAR(regions[1].from_um, 225.0, 1e-12);
  EXPECT_NEAR(regions[1].to_um, 285.0, 1e-12);
  EXPECT_NEAR(regions[2].from_um, 135.0, 1e-12);
  EXPECT_NEAR(regions[2].to_um, 165.0, 1e-12);
}

TEST(FlatGroove, CountsThePointsOfItsRegions) {
  const GrooveStep step = given(iso5436_a1(groove(50.0, 0.0, 0.0), with_edges()));

  EXPECT_TRUE(step.edges_given);
  EXPECT_EQ(step.regions[0].name, "A");
  EXPECT_EQ(step.regions[0].points, 60 * 90);
  EXPECT_EQ(step.regions[1].asked, 60 * 90);
  EXPECT_EQ(step.regions[2].name, "C");
  EXPECT_EQ(step.regions[2].points, 30 * 90);
  EXPECT_NEAR(step.regions[2].mean_z_um, -47.0, 1e-12);
  EXPECT_EQ(step.areal.points, 150 * 90);
  EXPECT_EQ(step.traces.each.front().points, 150 * 10);
  EXPECT_NEAR(step.correlation_factor, 1.0, 1e-9);
}

TEST(FlatGroove, CountsCentresOnTheBordersOfRegions) {
  GrooveSettings settings;
  settings.edges = GrooveEdges{105.5, 195.5};

  const GrooveStep step = given(iso5436_a1(groove(50.0, 0.0, 0.0), settings));

  EXPECT_EQ(step.regions[0].asked, 61 * 90);
  EXPECT_EQ(step.regions[1].asked, 61 * 90);
  EXPECT_EQ(step.regions[2].asked, 31 * 90);
}

TEST(FlatGroove, MeasuresARidgeUpwards) {
  const GrooveStep step = given(iso5436_a1(groove(-12.0, -0.03, 0.02), {}));

  EXPECT_EQ(step.sign, GrooveSign::kRidge);
  EXPECT_NEAR(step.areal.height_um, 12.0 / std::sqrt(1.0013), 1e-10);
  EXPECT_NEAR(step.mean.height_um, 12.0 / std::sqrt(1.0009), 1e-10);
  EXPECT_NEAR(step.plain_means_um, 12.0, 1e-10);
}

TEST(FlatGroove, GivesTheSameAlongY) {
  HeightField field = groove(50.0, 0.02, 0.01, 77);
  add_white_noise(field, 0.3, 8);
  punch_holes(field, 0.1, 9);
  GrooveSettings settings;
  settings.band = FromTo{5.0, 70.0};
  settings.traces = 7;
  const GrooveStep along_x = given(iso5436_a1(field, settings));
  settings.across = Across::kY;

  const GrooveStep along_y = given(iso5436_a1(transposed(field), settings));

  EXPECT_EQ(along_y.edges.left_um, along_x.edges.left_um);
  EXPECT_EQ(along_y.edges.right_um, along_x.edges.right_um);
  EXPECT_NEAR(along_y.mean.height_um, along_x.mean.height_um, 5e-11);
  EXPECT_NEAR(along_y.areal.height_um, along_x.areal.height_um, 5e-11);
  EXPECT_NEAR(along_y.areal.slope_y, along_x.areal.slope_x, 1e-13);
  EXPECT_EQ(along_y.mean.points, along_x.mean.points);
  EXPECT_NEAR(along_y.mean.weights.at(40, 60), along_x.mean.weights.at(60, 40), 1e-16);
  EXPECT_NE(along_x.mean.weights.at(60, 40), 0.0);
}

TEST(FlatGroove, GivesTheSameInAMirror) {
  HeightField field = groove(50.0, 0.02, 0.01);
  add_white_noise(field, 0.3, 10);

  const GrooveStep straight = given(iso5436_a1(field, {}));
  const GrooveStep in_mirror = given(iso5436_a1(mirrored(field), {}));

  EXPECT_NEAR(in_mirror.edges.left_um, 300.0 - straight.edges.right_um, 1e-9);
  EXPECT_NEAR(in_mirror.mean.height_um, straight.mean.height_um, 5e-11);
  EXPECT_NEAR(in_mirror.areal.height_um, straight.areal.height_um, 5e-11);
}

TEST(FlatGroove, WeightsAreTheDerivatives) {
  HeightField field = groove(20.0, 0.1, -0.2, 30);
  add_white_noise(field, 0.2, 11);
  punch_holes(field, 0.1, 12);
  const GrooveSettings settings = with_edges();
  const GrooveStep step = given(iso5436_a1(field, settings));

  expect_weights_are_derivatives(
      field, step.mean.weights,
      [&](const HeightField& changed) { return given(iso5436_a1(changed, settings)).mean.height_um; }, 1e-10);
  expect_weights_are_derivatives(
      field, step.areal.weights,
      [&](const HeightField& changed) { return given(iso5436_a1(changed, settings)).areal.height_um; }, 1e-10);
}

TEST(FlatGroove, SharesTheBandAmongItsTraces) {
  GrooveSettings settings = with_edges();
  settings.band = FromTo{10.0, 70.0};
  settings.traces = 6;
  settings.trace_width_um = 4.0;

  const GrooveStep step = given(iso5436_a1(groove(50.0, 0.0, 0.0), settings));

  ASSERT_EQ(step.traces.each.size(), 6U);
  EXPECT_NEAR(step.traces.each[0].from_um, 13.0, 1e-12);
  EXPECT_NEAR(step.traces.each[0].to_um, 17.0, 1e-12);
  EXPECT_NEAR(step.traces.each[5].from_um, 63.0, 1e-12);
  EXPECT_EQ(step.traces.each[0].points, 150 * 4);
}

TEST(FlatGroove, TakesARowWhereATraceIsNarrow) {
  GrooveSettings settings = with_edges();
  settings.traces = 6;
  settings.band = FromTo{10.0, 70.0};
  settings.trace_width_um = 0.1;

  const GrooveStep step = given(iso5436_a1(groove(50.0, 0.02, 0.01), settings));

  ASSERT_EQ(step.traces.each.size(), 6U);
  EXPECT_EQ(step.traces.each[0].points, 150);
  EXPECT_NE(step.mean.weights.at(20, 15), 0.0);
  EXPECT_EQ(step.mean.weights.at(20, 14), 0.0);
  EXPECT_NEAR(step.mean.height_um, 50.0 / std::sqrt(1.0004), 1e-10);
}

TEST(FlatGroove, LooksForEdgesOverTheFocusWindow) {
  // Walls that the window made 9 points wide: from a point to the next they do not stand out of the noise.
  HeightField field = make_field(300, 49, 1.0, 1.0, [](double x, double) {
    const double from_wall = std::min(x - 105.0, 195.0 - x);
    return -5.0 * std::clamp(from_wall / 9.0 + 0.5, 0.0, 1.0);
  });
  add_white_noise(field, 0.56, 13);
  field.kernel.weights.assign(9, 1.0 / 9.0);

  const GrooveStep step = given(iso5436_a1(field, {}));

  EXPECT_NEAR(step.edges.left_um, 105.0, 1.0);
  EXPECT_NEAR(step.edges.right_um, 195.0, 1.0);
}

TEST(FlatGroove, LeavesOutTracesWithTooFewPoints) {
  HeightField field = groove(50.0, 0.0, 0.0);
  for (int row = 0; row < 20; ++row) {
    for (int column = 15; column < 40; ++column) field.z_um.at(column, row) = kHole;
  }

  const GrooveStep step = given(iso5436_a1(field, with_edges()));

  EXPECT_EQ(step.traces.left_out, 2);
  EXPECT_EQ(step.traces.each.size(), 7U);
  EXPECT_NEAR(step.traces.each.front().from_um, 20.0, 1e-12);
}

TEST(FlatGroove, StatesTheSpreadOfItsTraces) {
  // Each of five strips is deeper by 1 um than the one before: 48, ..., 52.
  const HeightField field = make_field(300, 50, 1.0, 1.0, [](double x, double y) {
    return std::abs(x - kCentre) < kWidth / 2.0 ? -48.0 - std::floor(y / 10.0) : 0.0;
  });
  GrooveSettings settings = with_edges();
  settings.traces = 5;

  const GrooveStep step = given(iso5436_a1(field, settings));

  EXPECT_NEAR(step.traces.mean_um, 50.0, 1e-10);
  EXPECT_NEAR(step.traces.sd_um, std::sqrt(2.5), 1e-10);
  EXPECT_NEAR(step.mean.height_um, 50.0, 1e-10);
  EXPECT_NEAR(step.traces.each[3].height_um, 51.0, 1e-10);
}

TEST(FlatGroove, RefusesWhatItCannotMeasure) {
  const HeightField field = groove(50.0, 0.0, 0.0);
  GrooveSettings beside = with_edges();
  beside.band = FromTo{50.0, 120.0};
  GrooveSettings wide = with_edges();
  wide.edges = GrooveEdges{50.0, 250.0};
  // A reaches from -30 to 37 um.
  GrooveSettings at_border = with_edges();
  at_border.edges = GrooveEdges{70.0, 170.0};
  GrooveSettings low = with_edges();
  low.band = FromTo{10.0, 18.0};
  HeightField without_bottom = groove(50.0, 0.0, 0.0);
  for (int row = 0; row < 90; ++row) {
    for (int column = 135; column < 145; ++column) without_bottom.z_um.at(column, row) = kHole;
  }
  HeightField in_few_rows = groove(50.0, 0.0, 0.0);
  for (int row = 0; row < 90; ++row) {
    // Five of nine strips have a third of A only; over the band A has 63 %.
    for (int column = 15; row < 50 && column < 55; ++column) in_few_rows.z_um.at(column, row) = kHole;
  }
  HeightField without_a = groove(50.0, 0.0, 0.0);
  for (int row = 0; row < 90; ++row) {
    for (int column = 0; column < 100; ++column) without_a.z_um.at(column, row) = kHole;
  }
  GrooveSettings all_tolerant = with_edges();
  all_tolerant.min_valid_fraction = 0.0;
  GrooveSettings tolerant = with_edges();
  tolerant.min_valid_fraction = 0.6;

  const StepRefusal holes = refused(iso5436_a1(without_bottom, with_edges()));
  const StepRefusal few = refused(iso5436_a1(in_few_rows, tolerant));

  EXPECT_EQ(refused(iso5436_a1(field, beside)).code, StepRefusalCode::kOutside);
  EXPECT_EQ(refused(iso5436_a1(field, wide)).code, StepRefusalCode::kOutside);
  EXPECT_EQ(refused(iso5436_a1(field, at_border)).code, StepRefusalCode::kOutside);
  EXPECT_EQ(refused(iso5436_a1(field, low)).code, StepRefusalCode::kTooFewTraces);
  EXPECT_EQ(refused(iso5436_a1(groove(0.0, 0.02, 0.01), {})).code, StepRefusalCode::kNoEdges);
  EXPECT_EQ(holes.code, StepRefusalCode::kTooFewValid);
  EXPECT_NEAR(holes.figure.value_or(0.0), 2.0 / 3.0, 1e-12);
  EXPECT_NE(holes.text.find("region C"), std::string::npos);
  EXPECT_EQ(refused(iso5436_a1(without_a, all_tolerant)).code, StepRefusalCode::kTooFewValid);
  EXPECT_EQ(few.code, StepRefusalCode::kTooFewTraces);
  EXPECT_EQ(few.figure, std::optional(4.0));
}

TEST(FlatGroove, ThrowsForSettingsThatBreakARule) {
  const HeightField field = groove(50.0, 0.0, 0.0);
  GrooveSettings four = with_edges();
  four.traces = 4;
  GrooveSettings crossed_band = with_edges();
  crossed_band.band = FromTo{40.0, 40.0};
  GrooveSettings crossed_edges;
  crossed_edges.edges = GrooveEdges{100.0, 50.0};
  GrooveSettings crossed_search;
  crossed_search.search = FromTo{100.0, 50.0};
  GrooveSettings no_width = with_edges();
  no_width.trace_width_um = 0.0;

  for (const GrooveSettings& settings : {four, crossed_band, crossed_edges, crossed_search, no_width}) {
    EXPECT_THROW((void)iso5436_a1(field, settings), Error);
    EXPECT_THROW((void)iso5436_a2(field, settings), Error);
  }
}

TEST(FlatGroove, LooksForEdgesWhereItIsTold) {
  // The deeper groove is outside of the search.
  const HeightField field = make_field(600, 20, 1.0, 1.0, [](double x, double) {
    if (std::abs(x - 450.0) < 20.0) return -80.0;
    return std::abs(x - kCentre) < kWidth / 2.0 ? -50.0 : 0.0;
  });
  GrooveSettings settings;
  settings.search = FromTo{60.0, 300.0};

  const GrooveStep step = given(iso5436_a1(field, settings));

  EXPECT_NEAR(step.edges.left_um, 105.0, 1e-9);
  EXPECT_NEAR(step.edges.right_um, 195.0, 1e-9);
  EXPECT_NEAR(step.mean.height_um, 50.0, 1e-10);
}

}  // namespace
}  // namespace fvd::metrology
