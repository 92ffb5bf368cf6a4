#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/metrology/edge/cutting_edge.hpp"
#include "core/metrology/uncertainty/noise_map.hpp"
#include "tests/core/metrology/edge/edge_fields.hpp"

namespace fvd::metrology {
namespace {

using edge_test::make_field;
using edge_test::WedgeTruth;

EdgeOptions short_flanks() {
  EdgeOptions options;
  options.flank_to_um = 60.0;
  return options;
}

WedgeTruth short_edge(double radius_um) {
  WedgeTruth truth;
  truth.middle_x_um = 70.3;
  truth.middle_y_um = 60.0;
  truth.set_circle(radius_um);
  return truth;
}

TEST(EdgeUncertainty, IsTheScatterOfRepeatedMeasurements) {
  const HeightField clean = [] {
    HeightField field = make_field(short_edge(10.0), 140, 120, 9, 0.0, 1);
    for (float& sigma : field.sigma_um.pixels()) sigma = 0.2F;
    return field;
  }();
  NoiseMaps noise(clean, 11);
  HeightField noisy = clean.clone();
  double squares = 0.0;
  double u_squares = 0.0;
  double section_squares = 0.0;
  double section_u_squares = 0.0;
  constexpr int kDraws = 16;
  for (int draw = 0; draw < kDraws; ++draw) {
    noise.add_to_heights(static_cast<std::uint64_t>(draw), noisy.z_um);
    const CuttingEdge edge = measure_cutting_edge(noisy, {}, short_flanks());
    const EdgeValue& radius = edge.value(EdgeQuantity::kRadius);
    squares += std::pow(*radius.median - 10.0, 2);
    u_squares += std::pow(*radius.u_noise, 2);
    const EdgeSection& section = edge.sections[4];
    section_squares += std::pow(*section.value(EdgeQuantity::kRadius) - 10.0, 2);
    section_u_squares += std::pow(*section.u[static_cast<std::size_t>(EdgeQuantity::kRadius)], 2);
  }

  EXPECT_NEAR(std::sqrt(section_squares / section_u_squares), 1.0, 0.35);
  EXPECT_NEAR(std::sqrt(squares / u_squares), 0.95, 0.35);
}

TEST(EdgeUncertainty, IsAbsentWithoutSigma) {
  HeightField field = make_field(short_edge(10.0), 140, 120, 9, 0.0, 1);
  field.sigma_um = {};

  const CuttingEdge edge = measure_cutting_edge(field, {}, short_flanks());

  EXPECT_NEAR(*edge.value(EdgeQuantity::kRadius).median, 10.0, 0.02);
  EXPECT_FALSE(edge.value(EdgeQuantity::kRadius).u);
  EXPECT_EQ(edge.value(EdgeQuantity::kRadius).u_reason, EdgeReason::kNoSigma);
}

TEST(EdgeValues, AreAtMostWhereTheWindowHidesTheRounding) {
  const HeightField field = make_field(short_edge(2.0), 140, 120, 9, 0.0, 1);

  const CuttingEdge edge = measure_cutting_edge(field, {}, short_flanks());

  EXPECT_NEAR(edge.radius_smallest_resolvable_um, 4.5, 0.05);
  EXPECT_TRUE(edge.value(EdgeQuantity::kRadius).at_most);
  EXPECT_NEAR(*edge.value(EdgeQuantity::kRadius).median, 2.0, 0.1);
  EXPECT_FALSE(edge.value(EdgeQuantity::kK).median);
  EXPECT_EQ(edge.value(EdgeQuantity::kK).reason, EdgeReason::kBelowResolution);
}

TEST(EdgeMethods, LeaveOutWhatTheyDoNotGive) {
  const HeightField field = make_field(short_edge(10.0), 140, 120, 1, 0.0, 1);
  EdgeOptions options = short_flanks();

  options.method = EdgeMethod::kCircle;
  const CuttingEdge circle = measure_cutting_edge(field, {}, options);
  options.method = EdgeMethod::kTolerance;
  const CuttingEdge tolerance = measure_cutting_edge(field, {}, options);

  EXPECT_NEAR(*circle.value(EdgeQuantity::kSGamma).median, 10.0, 0.02);
  EXPECT_EQ(circle.value(EdgeQuantity::kK).reason, EdgeReason::kNotDefinedByMethod);
  EXPECT_EQ(tolerance.tolerance_um, 0.5);
  EXPECT_EQ(tolerance.value(EdgeQuantity::kRadius).reason, EdgeReason::kNotCorrected);
  EXPECT_EQ(tolerance.value(EdgeQuantity::kRMin).reason, EdgeReason::kNotDefinedByMethod);
  // The contour is 0.5 um off the line where (S - s)^2 = 2 r t - t^2.
  EXPECT_NEAR(*tolerance.value(EdgeQuantity::kSGamma).median, 10.0 - std::sqrt(2.0 * 10.0 * 0.5 - 0.25), 0.08);
  EXPECT_NEAR(*tolerance.value(EdgeQuantity::kSAlpha).median, 10.0 - std::sqrt(2.0 * 10.0 * 0.5 - 0.25), 0.08);
  EXPECT_NEAR(*tolerance.value(EdgeQuantity::kDeltaR).median, 4.142, 0.03);
}

TEST(EdgeMethods, ToleranceTellsTheRakeFromTheClearance) {
  WedgeTruth truth = short_edge(10.0);
  truth.s_gamma_um = 20.0;
  truth.s_alpha_um = 10.0;
  EdgeOptions options = short_flanks();
  options.flank_from_um = 25.0;
  options.method = EdgeMethod::kTolerance;

  const CuttingEdge edge = measure_cutting_edge(make_field(truth, 140, 120, 1, 0.0, 1), {}, options);

  EXPECT_GT(*edge.value(EdgeQuantity::kK).median, 1.5);
  EXPECT_NEAR(*edge.value(EdgeQuantity::kDeltaR).median, 5.578, 0.05);
  EXPECT_NEAR(*edge.value(EdgeQuantity::kPhi).median, 8.08, 1.5);
}

TEST(EdgeReasons, SayWhyThereIsNothing) {
  HeightField field = make_field(short_edge(10.0), 140, 120, 9, 0.0, 1);
  HeightField upside_down = field.clone();
  for (double& z : upside_down.z_um.pixels()) z = -z;
  HeightField flat = field.clone();
  for (double& z : flat.z_um.pixels()) z = 5.0;
  HeightField empty = field.clone();
  for (double& z : empty.z_um.pixels()) z = std::numeric_limits<double>::quiet_NaN();
  EdgeOptions along = short_flanks();
  along.rake_side = RakeSide::kTop;

  EXPECT_EQ(measure_cutting_edge(upside_down, {}, short_flanks()).reason, EdgeReason::kNotConvex);
  EXPECT_EQ(measure_cutting_edge(flat, {}, short_flanks()).reason, EdgeReason::kNotConvex);
  EXPECT_EQ(measure_cutting_edge(empty, {}, short_flanks()).reason, EdgeReason::kTooFewPoints);
  EXPECT_EQ(measure_cutting_edge(field, {}, along).reason, EdgeReason::kRakeSideAmbiguous);
}

}  // namespace
}  // namespace fvd::metrology
