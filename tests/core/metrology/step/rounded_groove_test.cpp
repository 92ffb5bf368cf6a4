#include <cmath>

#include <gtest/gtest.h>

#include "core/metrology/step/groove_step.hpp"
#include "tests/core/metrology/step/step_fields.hpp"

namespace fvd::metrology {
namespace {

constexpr double kRadius = 60.0;
constexpr double kDepth = 25.0;
constexpr double kCentre = 150.0;
const double kHalfWidth = std::sqrt(2.0 * kRadius * kDepth - kDepth * kDepth);

/// A cylinder along y, `depth` deep below a level surface; turned in the x-z plane by the angle whose tangent is
/// slope_x about (150, 0), so that its depth perpendicular to the surface is the same. sign: -1 for a ridge.
HeightField cylinder(double slope_x, double slope_y, double sign, int rows = 45) {
  const double cosine = 1.0 / std::sqrt(1.0 + slope_x * slope_x);
  const double sine = slope_x * cosine;
  return make_field(300, rows, 1.0, 1.0, [=](double x, double y) {
    const double u = x - kCentre;
    const double tilt = slope_x * u + slope_y * y;
    if (std::abs(u / cosine) > kHalfWidth) return tilt;
    // The axis stands above the surface of a groove, and below that of a ridge.
    const double above = sign * (kRadius - kDepth);
    const double axis_u = -sine * above;
    const double axis_z = cosine * above;
    const double across = u - axis_u;
    return slope_y * y + axis_z - sign * std::sqrt(kRadius * kRadius - across * across);
  });
}

GrooveSettings with_edges() {
  GrooveSettings settings;
  settings.edges = GrooveEdges{kCentre - kHalfWidth, kCentre + kHalfWidth};
  settings.traces = 5;
  return settings;
}

TEST(RoundedGroove, FindsTheVertexOfACircle) {
  for (const double sign : {1.0, -1.0}) {
    for (const double slope : {0.0, 0.05, -0.1}) {
      HeightField field = cylinder(slope, 0.01, sign);
      punch_holes(field, 0.1, 41);

      const RoundedGroove groove = given(iso5436_a2(field, with_edges()));

      EXPECT_EQ(groove.sign, sign > 0.0 ? GrooveSign::kGroove : GrooveSign::kRidge);
      EXPECT_NEAR(groove.mean.height_um, kDepth, 1e-9) << slope;
      EXPECT_NEAR(groove.mean.vertical_um, kDepth * std::sqrt(1.0 + slope * slope), 1e-9) << slope;
      EXPECT_NEAR(groove.radius_um, kRadius, 1e-7) << slope;
      EXPECT_NEAR(groove.mean.slope_x, slope, 1e-12);
      ASSERT_EQ(groove.traces.each.size(), 5U);
      EXPECT_NEAR(groove.traces.each[2].slope, slope, 1e-12);
      EXPECT_LT(groove.traces.sd_um, 1e-9);
    }
  }
}

TEST(RoundedGroove, FindsTheVertexOfAParabola) {
  // z = u^2 / 80 - 20 below a line of slope 0.1: deepest where u / 40 = 0.1, by 20 + 0.2.
  const HeightField field = make_field(300, 45, 1.0, 1.0, [](double x, double) {
    const double u = x - kCentre;
    return std::abs(u) < 40.0 ? u * u / 80.0 - 20.0 : 0.1 * u;
  });
  GrooveSettings settings;
  settings.edges = GrooveEdges{110.0, 190.0};

  const RoundedGroove groove = given(iso5436_a2(field, settings, BottomForm::kParabola));

  EXPECT_NEAR(groove.mean.vertical_um, 20.2, 1e-10);
  EXPECT_NEAR(groove.mean.height_um, 20.2 / std::sqrt(1.01), 1e-10);
  EXPECT_NEAR(groove.radius_um, 40.0 * std::pow(1.01, 1.5), 1e-8);
  EXPECT_EQ(groove.form, BottomForm::kParabola);
}

TEST(RoundedGroove, GivesTheSameAlongY) {
  HeightField field = cylinder(0.05, 0.02, 1.0);
  add_white_noise(field, 0.05, 42);
  GrooveSettings settings = with_edges();
  const RoundedGroove along_x = given(iso5436_a2(field, settings));
  settings.across = Across::kY;

  const RoundedGroove along_y = given(iso5436_a2(transposed(field), settings));

  EXPECT_NEAR(along_y.mean.height_um, along_x.mean.height_um, 1e-9);
  EXPECT_NEAR(along_y.radius_um, along_x.radius_um, 1e-7);
  EXPECT_NEAR(along_y.mean.weights.at(20, 150), along_x.mean.weights.at(150, 20), 1e-12);
}

TEST(RoundedGroove, WeightsAreTheDerivatives) {
  for (const BottomForm form : {BottomForm::kCircle, BottomForm::kParabola}) {
    for (const double sign : {1.0, -1.0}) {
      HeightField field = cylinder(0.1, -0.2, sign, 20);
      // A little noise, for the derivatives take the residuals of the bottom to be small.
      add_white_noise(field, 1e-6, 43);
      punch_holes(field, 0.1, 44);
      if (form == BottomForm::kParabola) {
        // A circle has large residuals to a parabola.
        for (int row = 0; row < field.height(); ++row) {
          for (int column = 130; column < 170; ++column) {
            const double u = field.x_um(column) - kCentre;
            if (!field.is_hole(column, row)) {
              field.z_um.at(column, row) = sign * (u * u / 80.0 - 20.0) - 0.2 * field.y_um(row);
            }
          }
        }
      }
      const RoundedGroove groove = given(iso5436_a2(field, with_edges(), form));

      expect_weights_are_derivatives(
          field, groove.mean.weights,
          [&](const HeightField& changed) { return given(iso5436_a2(changed, with_edges(), form)).mean.height_um; },
          2e-7);
    }
  }
}

TEST(RoundedGroove, FindsItsEdges) {
  const RoundedGroove groove = given(iso5436_a2(cylinder(0.0, 0.0, 1.0), {}));

  EXPECT_FALSE(groove.edges_given);
  EXPECT_NEAR(groove.edges.left_um + groove.edges.right_um, 300.0, 1e-9);
  // The wall is steepest at the rim; half as steep, and so the flank's end, where u / sqrt(r^2 - u^2) is half of that.
  const double half_as_steep = 0.5 * kHalfWidth / (kRadius - kDepth);
  const double end = kRadius * half_as_steep / std::sqrt(1.0 + half_as_steep * half_as_steep);
  EXPECT_NEAR(groove.edges.width_um(), kHalfWidth + end, 2.0);
  EXPECT_NEAR(groove.mean.height_um, kDepth, 1e-9);
}

TEST(RoundedGroove, IsRefusedWhereTheBottomIsNotRounded) {
  const auto with_bottom = [](const auto& bottom) {
    return make_field(300, 45, 1.0, 1.0, [=](double x, double) {
      const double u = x - kCentre;
      return std::abs(u) < kHalfWidth ? bottom(u) : 0.0;
    });
  };
  const HeightField bulging = with_bottom([](double u) { return -20.0 - u * u / 200.0; });
  const HeightField beside = with_bottom([](double u) { return -20.0 + 0.5 * u + u * u / 200.0; });
  const HeightField other_side = with_bottom([](double u) { return -20.0 - 0.5 * u + u * u / 200.0; });
  const HeightField flat = with_bottom([](double) { return -20.0; });

  for (const BottomForm form : {BottomForm::kCircle, BottomForm::kParabola}) {
    EXPECT_EQ(refused(iso5436_a2(bulging, with_edges(), form)).code, StepRefusalCode::kNotRounded);
    EXPECT_EQ(refused(iso5436_a2(beside, with_edges(), form)).code, StepRefusalCode::kNotRounded);
    EXPECT_EQ(refused(iso5436_a2(other_side, with_edges(), form)).code, StepRefusalCode::kNotRounded);
  }
  EXPECT_EQ(refused(iso5436_a2(flat, with_edges())).code, StepRefusalCode::kNotRounded);
}

TEST(RoundedGroove, HasTheNoiseOfItsWeights) {
  HeightField field = cylinder(0.0, 0.0, 1.0);
  set_uniform_sigma(field, 0.1);

  const RoundedGroove groove = given(iso5436_a2(field, with_edges()));

  ASSERT_TRUE(groove.mean.noise.has_value());
  double squares = 0.0;
  for (const double weight : groove.mean.weights.weights.pixels()) squares += weight * weight;
  EXPECT_NEAR(groove.mean.noise->u, static_cast<double>(0.1F) * std::sqrt(squares), 1e-12);
}

TEST(RoundedGroove, LeavesOutTracesWithTooFewPoints) {
  HeightField field = cylinder(0.0, 0.0, 1.0);
  for (int row = 0; row < 9; ++row) {
    for (int column = 140; column < 160; ++column) field.z_um.at(column, row) = kHole;
  }
  GrooveSettings settings = with_edges();

  const StepRefusal few = refused(iso5436_a2(field, settings));
  settings.traces = 9;
  const RoundedGroove groove = given(iso5436_a2(field, settings));

  EXPECT_EQ(few.code, StepRefusalCode::kTooFewTraces);
  EXPECT_EQ(groove.traces.left_out, 2);
  EXPECT_NEAR(groove.mean.height_um, kDepth, 1e-9);
}

}  // namespace
}  // namespace fvd::metrology
