#include "core/metrology/edge/cutting_edge.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/core/metrology/edge/edge_fields.hpp"

namespace fvd::metrology {
namespace {

using edge_test::make_field;
using edge_test::WedgeTruth;

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

struct Direction {
  double degrees;
  RakeSide rake;
};
constexpr Direction kDirections[] = {{90.0, RakeSide::kLeft}, {107.0, RakeSide::kLeft}, {0.0, RakeSide::kBottom}};

WedgeTruth wedge(double direction_deg) {
  WedgeTruth truth;
  truth.direction_deg = direction_deg;
  // Along x it lies in the middle of an upright field, else of a lying one.
  truth.middle_x_um = direction_deg == 0.0 ? 60.2 : 100.3;
  truth.middle_y_um = direction_deg == 0.0 ? 100.3 : 60.2;
  return truth;
}

HeightField field_of(const WedgeTruth& truth) {
  const bool upright = truth.direction_deg == 0.0;
  return make_field(truth, upright ? 120 : 200, upright ? 200 : 120, 9, 0.0, 1);
}

double median_of(const CuttingEdge& edge, EdgeQuantity quantity) { return edge.value(quantity).median.value_or(kHole); }

TEST(CuttingEdge, ReadsRadiusAndWedgeAngleInEveryDirection) {
  for (const Direction& direction : kDirections) {
    for (const double radius : {25.0, 10.0, 5.0}) {
      WedgeTruth truth = wedge(direction.degrees);
      truth.set_circle(radius);
      EdgeOptions options;
      options.rake_side = direction.rake;

      const CuttingEdge edge = measure_cutting_edge(field_of(truth), {}, options);

      EXPECT_EQ(edge.reason, EdgeReason::kNone);
      EXPECT_NEAR(median_of(edge, EdgeQuantity::kRadius), radius, 0.003 * radius) << direction.degrees;
      EXPECT_NEAR(median_of(edge, EdgeQuantity::kBeta), 90.0, 0.02) << direction.degrees;
      EXPECT_NEAR(std::remainder(edge.direction_deg - direction.degrees, 180.0), 0.0, 0.05);
    }
  }
}

TEST(CuttingEdge, ReadsASharpEdgeAsSharpAndApparentlyRound) {
  for (const Direction& direction : kDirections) {
    EdgeOptions options;
    options.rake_side = direction.rake;

    const CuttingEdge edge = measure_cutting_edge(field_of(wedge(direction.degrees)), {}, options);

    EXPECT_LT(median_of(edge, EdgeQuantity::kRadius), 0.6) << direction.degrees;
    EXPECT_NEAR(median_of(edge, EdgeQuantity::kRadiusApparent), 5.5, 0.2) << direction.degrees;
  }
}

TEST(CuttingEdge, TakesTheOperatorsSpreadForNoRounding) {
  WedgeTruth truth = wedge(90.0);
  truth.set_circle(5.0);
  const HeightField sharp = make_field(truth, 202, 120, 5, 0.0, 1);
  HeightField field = make_field(truth, 200, 120, 5, 0.0, 1);
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 1; column < 199; ++column) {
      field.z_um.at(column, row) = 0.25 * sharp.z_um.at(column - 1, row) + 0.5 * sharp.z_um.at(column, row) +
                                   0.25 * sharp.z_um.at(column + 1, row);
    }
  }

  const CuttingEdge without = measure_cutting_edge(field, {}, {});
  field.kernel.operator_px2 = 0.5;
  const CuttingEdge with = measure_cutting_edge(field, {}, {});

  EXPECT_NEAR(median_of(with, EdgeQuantity::kRadius), 5.0, 0.02);
  EXPECT_NEAR(median_of(without, EdgeQuantity::kRadius), std::sqrt(25.0 + 0.5 / 0.2146), 0.03);
  EXPECT_EQ(with.window_um, without.window_um);
}

TEST(CuttingEdge, ReadsAsymmetryInEveryDirection) {
  for (const Direction& direction : kDirections) {
    for (const double k : {0.5, 2.0}) {
      WedgeTruth truth = wedge(direction.degrees);
      truth.s_gamma_um = 20.0 * std::fmax(1.0, k);
      truth.s_alpha_um = truth.s_gamma_um / k;
      EdgeOptions options;
      options.rake_side = direction.rake;

      const CuttingEdge edge = measure_cutting_edge(field_of(truth), {}, options);

      EXPECT_NEAR(median_of(edge, EdgeQuantity::kK), k, 0.005) << direction.degrees;
      EXPECT_NEAR(median_of(edge, EdgeQuantity::kSGamma), truth.s_gamma_um, 0.05) << direction.degrees;
      EXPECT_NEAR(median_of(edge, EdgeQuantity::kSAlpha), truth.s_alpha_um, 0.05) << direction.degrees;
      EXPECT_NEAR(median_of(edge, EdgeQuantity::kPhi), std::copysign(8.083, k - 1.0), 0.03);
    }
  }
}

TEST(CuttingEdge, ReadsAQuarterEllipse) {
  WedgeTruth truth = wedge(90.0);
  truth.s_gamma_um = 20.0;
  truth.s_alpha_um = 10.0;

  const CuttingEdge edge = measure_cutting_edge(make_field(truth, 200, 180, 1, 0.0, 1), {}, {});

  EXPECT_NEAR(median_of(edge, EdgeQuantity::kK), 2.0, 0.005);
  EXPECT_NEAR(median_of(edge, EdgeQuantity::kDeltaR), 5.578, 0.003);
  EXPECT_NEAR(median_of(edge, EdgeQuantity::kPhi), 8.083, 0.03);
  EXPECT_NEAR(median_of(edge, EdgeQuantity::kRMin), 5.0, 0.05);
}

TEST(CuttingEdge, KeepsItsValuesWhereTheRakeIsCalledTheOtherSide) {
  WedgeTruth truth = wedge(90.0);
  truth.rake_deg = 30.0;
  truth.clearance_deg = 50.0;
  truth.s_gamma_um = 30.0;
  truth.s_alpha_um = 20.0;
  truth.tilt = 0.2;
  const HeightField field = make_field(truth, 200, 180, 5, 0.0, 1);
  EdgeOptions left;
  EdgeOptions right;
  right.rake_side = RakeSide::kRight;

  const CuttingEdge one = measure_cutting_edge(field, {}, left);
  const CuttingEdge other = measure_cutting_edge(field, {}, right);

  EXPECT_NEAR(median_of(one, EdgeQuantity::kBeta), 100.0, 0.02);
  EXPECT_NEAR(median_of(one, EdgeQuantity::kSGamma), 30.0, 0.1);
  EXPECT_NEAR(median_of(one, EdgeQuantity::kSAlpha), 20.0, 0.1);
  EXPECT_NEAR(median_of(other, EdgeQuantity::kSGamma), 20.0, 0.1);
  EXPECT_NEAR(median_of(other, EdgeQuantity::kK), 2.0 / 3.0, 0.005);
  EXPECT_LT(median_of(other, EdgeQuantity::kPhi), -1.0);
}

TEST(CuttingEdge, FollowsABentAndTiltedEdge) {
  WedgeTruth truth = wedge(90.0);
  truth.set_circle(10.0);
  truth.bend_per_um = 1.0 / 1000.0;
  truth.tilt = 0.15;

  const CuttingEdge edge = measure_cutting_edge(field_of(truth), {}, {});

  EXPECT_NEAR(median_of(edge, EdgeQuantity::kRadius), 10.0, 0.05);
  EXPECT_NEAR(median_of(edge, EdgeQuantity::kBeta), 90.0, 0.03);
  EXPECT_LT(*edge.value(EdgeQuantity::kRadius).p90 - *edge.value(EdgeQuantity::kRadius).p10, 0.1);
  EXPECT_LT(*edge.chipping.edge_pt_um, 0.1);
}

TEST(CuttingEdge, StaysWithinItsBoundsUnderNoise) {
  for (const double radius : {10.0, 5.0}) {
    WedgeTruth truth = wedge(90.0);
    truth.middle_y_um = 150.0;
    truth.set_circle(radius);

    const CuttingEdge edge = measure_cutting_edge(make_field(truth, 200, 300, 9, 0.2, 3), {}, {});

    EXPECT_NEAR(median_of(edge, EdgeQuantity::kRadius), radius, radius == 5.0 ? 0.5 : 0.03 * radius);
    EXPECT_NEAR(median_of(edge, EdgeQuantity::kBeta), 90.0, 0.3);
    EXPECT_LT(std::abs(median_of(edge, EdgeQuantity::kRadius) - radius), 3.0 * *edge.value(EdgeQuantity::kRadius).u);
    EXPECT_TRUE(edge.chipping.notches.empty());
  }
  const CuttingEdge sharp = measure_cutting_edge(make_field(wedge(90.0), 200, 180, 9, 0.2, 3), {}, {});

  EXPECT_LT(median_of(sharp, EdgeQuantity::kRadius), 1.5);
  EXPECT_TRUE(sharp.value(EdgeQuantity::kRadius).at_most);
}

TEST(CuttingEdge, LeavesOutSectionsWhoseFlankIsPolished) {
  WedgeTruth truth = wedge(90.0);
  truth.set_circle(10.0);
  HeightField field = make_field(truth, 200, 180, 9, 0.1, 4);
  for (int row = 40; row < 80; ++row) {
    for (int column = 102; column < 200; ++column) {
      // A few points are left, and they are wrong.
      field.z_um.at(column, row) = (row * 7 + column * 3) % 31 == 0 ? 60.0 : kHole;
    }
  }

  const CuttingEdge edge = measure_cutting_edge(field, {}, {});

  EXPECT_NEAR(median_of(edge, EdgeQuantity::kRadius), 10.0, 0.4);
  int unmeasured = 0;
  for (const EdgeSection& section : edge.sections) unmeasured += section.state == EdgeReason::kFlankUnmeasured ? 1 : 0;
  EXPECT_EQ(unmeasured, 4);
  EXPECT_EQ(edge.sections_measured + unmeasured, 18);
  EXPECT_LT(edge.valid_fraction, 0.95);
  EXPECT_TRUE(edge.chipping.notches.empty());
}

TEST(CuttingEdge, KeepsToTheRegion) {
  WedgeTruth truth = wedge(90.0);
  truth.set_circle(10.0);
  truth.middle_y_um = 90.2;
  HeightField field = make_field(truth, 200, 180, 9, 0.0, 1);
  Region region(200, 180, 0);
  for (int row = 60; row < 140; ++row) {
    for (int column = 10; column < 190; ++column) region.at(column, row) = 1;
  }
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 200; ++column) field.z_um.at(column, row) = 500.0;
  }

  const CuttingEdge edge = measure_cutting_edge(field, region, {});

  EXPECT_NEAR(median_of(edge, EdgeQuantity::kRadius), 10.0, 0.03);
  EXPECT_NEAR(edge.chipping.length_um, 80.0, 1.0);
  for (const EdgeSection& section : edge.sections) {
    EXPECT_GT(section.y_um, 60.0);
    EXPECT_LT(section.y_um, 140.0);
    EXPECT_NEAR(section.x_um, 100.3, 0.05);
  }
}

}  // namespace
}  // namespace fvd::metrology
