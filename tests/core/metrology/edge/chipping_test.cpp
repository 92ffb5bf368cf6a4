#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/edge/cutting_edge.hpp"
#include "core/metrology/edge/notches.hpp"
#include "tests/core/metrology/edge/edge_fields.hpp"

namespace fvd::metrology {
namespace {

using edge::find_notches;
using edge_test::make_field;
using edge_test::WedgeTruth;

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

std::vector<EdgeLinePoint> flat_line(int count) {
  std::vector<EdgeLinePoint> line;
  for (int i = 0; i < count; ++i) line.push_back({i + 0.5, 10.0, i + 0.5, 5.0, 0.0});
  return line;
}

TEST(Notches, HaveDepthWidthAtHalfDepthAndArea) {
  std::vector<EdgeLinePoint> line = flat_line(100);
  // A triangle of depth 8 over 40 um.
  for (int i = 30; i <= 70; ++i) {
    line[static_cast<std::size_t>(i)].deviation_um = 8.0 * (1.0 - std::abs(i - 50) / 20.0);
  }

  const std::vector<Notch> notches = find_notches(line, {3.0, 10.0, 0.0, 18.0});

  ASSERT_EQ(notches.size(), 1U);
  EXPECT_DOUBLE_EQ(notches[0].depth_um, 8.0);
  EXPECT_NEAR(notches[0].width_um, 20.0, 1e-9);
  EXPECT_NEAR(notches[0].area_um2, 160.0, 1e-9);
  EXPECT_DOUBLE_EQ(notches[0].along_um, 50.5);
  EXPECT_FALSE(notches[0].open);
  EXPECT_TRUE(notches[0].resolved);
  EXPECT_FALSE(find_notches(line, {3.0, 10.0, 0.0, 21.0})[0].resolved);
  EXPECT_TRUE(find_notches(line, {8.1, 10.0, 0.0, 18.0}).empty());
  EXPECT_TRUE(find_notches(line, {3.0, 21.0, 0.0, 18.0}).empty());
}

TEST(Notches, AreOpenWhereTheyTouchWhatIsNotMeasured) {
  std::vector<EdgeLinePoint> line = flat_line(60);
  for (std::size_t i = 20; i < 26; ++i) line[i].deviation_um = 6.0;
  for (std::size_t i = 26; i < 34; ++i) line[i].deviation_um.reset();
  for (std::size_t i = 55; i < 60; ++i) line[i].deviation_um = 4.0;

  const std::vector<Notch> notches = find_notches(line, {3.0, 10.0, 0.1, 18.0});

  ASSERT_EQ(notches.size(), 2U);
  EXPECT_TRUE(notches[0].open);
  EXPECT_NEAR(notches[0].width_um, 6.0, 0.6);
  EXPECT_TRUE(notches[1].open);
}

TEST(Chipping, FindsNotchesAsDeepAsTheWindowShowsThem) {
  for (const double direction : {90.0, 107.0}) {
    for (const double depth : {4.0, 6.0}) {
      WedgeTruth truth;
      truth.direction_deg = direction;
      truth.middle_x_um = 100.3;
      truth.middle_y_um = 90.2;
      truth.notch_along_um = 20.0;
      truth.notch_depth_um = depth;
      truth.notch_width_um = 22.0;
      EdgeOptions options;
      options.chipping.min_depth_um = 1.5;
      const HeightField field = make_field(truth, 200, 180, 9, 0.2, 8);

      const CuttingEdge edge = measure_cutting_edge(field, {}, options);

      // The floor of the notch is wider than the window only if it is 4.5 um deep; else the truth is a mean of both.
      const double seen = depth >= 4.5 ? depth : depth + std::pow(4.5 - depth, 2) / 9.0;
      const double sharp = direction == 90.0 ? 2.25 : 2.28;
      ASSERT_EQ(edge.chipping.notches.size(), 1U) << direction << " " << depth;
      EXPECT_NEAR(edge.chipping.notches[0].depth_um, seen - sharp, 0.6) << direction;
      EXPECT_NEAR(edge.chipping.notches[0].width_um, 22.0, 4.0) << direction;
      EXPECT_NEAR(edge.chipping.deepest_um(), edge.chipping.notches[0].depth_um, 1e-12);
      EXPECT_FALSE(edge.chipping.notches[0].open);
    }
  }
}

TEST(Chipping, FindsANotchThatTakesAFifthOfTheEdge) {
  WedgeTruth truth;
  truth.direction_deg = 90.0;
  truth.middle_x_um = 100.3;
  truth.middle_y_um = 90.2;
  truth.notch_along_um = 20.0;
  truth.notch_depth_um = 5.0;
  truth.notch_width_um = 36.0;
  EdgeOptions options;
  options.chipping.min_depth_um = 1.5;
  const HeightField field = make_field(truth, 200, 180, 9, 0.2, 8);

  const CuttingEdge edge = measure_cutting_edge(field, {}, options);

  EXPECT_LT(edge.chipping.robust_sd_um, 0.4) << "the notch does not raise the limit it is found by";
  ASSERT_EQ(edge.chipping.notches.size(), 1U);
  EXPECT_NEAR(edge.chipping.notches[0].width_um, 36.0, 5.0);
}

TEST(Chipping, InventsNoNotchOnCleanEdges) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    WedgeTruth truth;
    truth.direction_deg = 90.0 + 10.0 * static_cast<double>(seed);
    truth.middle_x_um = 100.3;
    truth.middle_y_um = 90.2;
    truth.set_circle(5.0);
    EdgeOptions options;
    options.chipping.min_depth_um = 1.5;

    const CuttingEdge edge = measure_cutting_edge(make_field(truth, 200, 180, 9, 0.25, seed), {}, options);

    EXPECT_TRUE(edge.chipping.notches.empty()) << seed;
    EXPECT_GE(edge.chipping.depth_limit_um, 1.5);
  }
}

TEST(Chipping, CountsAHoleAtTheEdgeAsUnmeasured) {
  WedgeTruth truth;
  truth.middle_x_um = 100.3;
  truth.middle_y_um = 90.2;
  truth.set_circle(5.0);
  HeightField field = make_field(truth, 200, 180, 9, 0.1, 2);
  for (int row = 50; row < 68; ++row) {
    for (int column = 97; column < 105; ++column) field.z_um.at(column, row) = kHole;
  }
  // Holes away from the edge hide nothing that could be nearer.
  for (int row = 100; row < 130; ++row) {
    for (int column = 115; column < 125; ++column) field.z_um.at(column, row) = kHole;
  }

  const CuttingEdge edge = measure_cutting_edge(field, {}, {});

  EXPECT_NEAR(edge.chipping.unmeasured_um, 18.0, 1.1);
  EXPECT_TRUE(edge.chipping.notches.empty());
  EXPECT_NEAR(edge.chipping.unmeasured_fraction(), 18.0 / 180.0, 0.007);
}

TEST(Chipping, GivesTheHeightOfTheLineAndOfItsParts) {
  WedgeTruth truth;
  truth.middle_x_um = 100.5;
  truth.middle_y_um = 90.0;
  truth.notch_along_um = -54.0;
  truth.notch_depth_um = 8.0;
  truth.notch_width_um = 20.0;

  const CuttingEdge edge = measure_cutting_edge(make_field(truth, 200, 180, 9, 0.0, 1), {}, {});

  EXPECT_NEAR(*edge.chipping.edge_pt_um, 8.0 - 2.25, 0.05);
  // Rows 26 to 46 lie in the first two fifths.
  EXPECT_NEAR(*edge.chipping.edge_rz_um, 2.0 * (8.0 - 2.25) / 5.0, 0.1);
}

TEST(Chipping, CallsAPlaceUnmeasuredWhereAFlankIsNotThere) {
  WedgeTruth truth;
  truth.middle_x_um = 100.3;
  truth.middle_y_um = 90.2;
  truth.set_circle(5.0);
  HeightField field = make_field(truth, 200, 180, 9, 0.1, 3);
  for (int row = 60; row < 100; ++row) {
    // The window still shows the rake some points beyond the edge.
    for (int column = 106; column < 200; ++column) field.z_um.at(column, row) = kHole;
  }

  const CuttingEdge edge = measure_cutting_edge(field, {}, {});

  EXPECT_NEAR(edge.chipping.unmeasured_um, 40.0, 1.1);
  EXPECT_TRUE(edge.chipping.notches.empty());
}

}  // namespace
}  // namespace fvd::metrology
