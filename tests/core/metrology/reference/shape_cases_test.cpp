#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/metrology/edge/flank_lines.hpp"
#include "core/metrology/edge/rounding.hpp"
#include "core/metrology/edge/section_fit.hpp"
#include "core/metrology/edge/section_model.hpp"
#include "core/metrology/operations/form.hpp"
#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/step/joint_levels.hpp"
#include "core/metrology/uncertainty/linear_noise.hpp"
#include "tests/core/metrology/reference/reference_case.hpp"
#include "tests/core/metrology/step/step_fields.hpp"

namespace fvd::metrology::reference {
namespace {

constexpr double kRightAngle = static_cast<double>(kPi / 2.0L);

TEST(StepCase, TenIsATiltedGrooveWithHoles) {
  ReferenceCase reference(10, 300 * 90);
  HeightField field = make_field(300, 90, 1.0, 1.0, [](double x, double y) {
    return 3.0 + 0.02 * x + 0.01 * y - (std::abs(x - 150.0) < 45.0 ? 50.0 : 0.0);
  });
  punch_holes(field, 0.1, 1);

  const GrooveStep step = given(iso5436_a1(field, {}));

  reference.compare("vertical", step.areal.vertical_um, 50.0L, 50.0, 0.0);
  reference.compare("perpendicular", step.areal.height_um, 50.0L / std::sqrt(1.0005L), 49.98750, 1e-5);
  EXPECT_NEAR(step.areal.vertical_um, 50.0, 1e-9);
}

TEST(StepCase, ElevenIsWhiteNoise) {
  constexpr int kPoints = 60;  // in a width of the groove
  ReferenceCase reference(11, kPoints);
  HeightField groove = make_field(200, 9, 1.5, 1.5, [](double, double) { return 1.0; });
  groove.sigma_um = Plane<float>(200, 9, 1.0F);
  GrooveSettings settings;
  settings.edges = GrooveEdges{105.0, 195.0};

  const GrooveStep step = given(iso5436_a1(groove, settings));

  // A and B hold 2/3 of a width each, C a third: the two halves' means have 3/4 and 3 times the variance of a width's.
  const double variance = step.mean.noise.value().u * step.mean.noise->u * 9.0 * kPoints;
  reference.compare("variance", variance, 3.0L / 4.0L + 3.0L, 3.75, 0.0);

  constexpr int kLength = 600;
  struct Case {
    int gap;
    double factor;
  };
  for (const Case& one_sided : {Case{0, 2.0}, Case{kLength / 3, 3.0551}, Case{kLength, 5.2915}}) {
    const int upper = kLength + 2 * one_sided.gap;
    const HeightField field = make_field(upper + kLength, 1, 1.0, 1.0, [](double x, double) { return x; });
    PointGroups groups;
    groups.group = Plane<std::uint8_t>(field.width(), 1);
    groups.count = 2;
    for (int i = 0; i < kLength; ++i) {
      groups.group.at(i, 0) = 1;
      groups.group.at(upper + i, 0) = 2;
    }
    const auto levels = JointLevels::fit(field, groups, SlopeAxes::kX);
    ASSERT_TRUE(levels.has_value());
    // Variance of a difference of two means of n points, 2 / n, and of the slope, 6 / (n (n n - 1)), times the
    // distance.
    const auto n = static_cast<long double>(kLength);
    const long double distance = n + 2.0L * one_sided.gap;
    const long double factor = std::sqrt(1.0L + 3.0L * distance * distance / (n * n - 1.0L));
    reference.compare("factor", levels->correlation_factor(2, 1), factor, one_sided.factor, 5e-5);
  }
}

TEST(EdgeCase, TwelveIsACircle) {
  ReferenceCase reference(12, 0);
  struct Case {
    double beta_deg, s_um, delta_r_um;
  };
  for (const Case& expected : {Case{90.0, 10.0, 4.142136}, Case{70.0, 14.28148, 7.434468}}) {
    const long double half = static_cast<long double>(expected.beta_deg) / 2.0L * kPi / 180.0L;

    const edge::Rounding circle = edge::Rounding::circle(static_cast<double>(2.0L * half), 10.0);
    const edge::NearestPoint nearest = edge::nearest_to_apex(circle);

    reference.compare("S", circle.s_gamma_um, 10.0L / std::tan(half), expected.s_um, 5e-6);
    reference.compare("K", circle.s_gamma_um / circle.s_alpha_um, 1.0L, 1.0, 0.0);
    reference.compare("Delta_r", nearest.delta_r_um, 10.0L / std::sin(half) - 10.0L, expected.delta_r_um, 5e-7);
    reference.compare("phi", nearest.phi_deg, 0.0L, 0.0, 0.0, 180.0);
  }
}

TEST(EdgeCase, ThirteenIsAQuarterEllipse) {
  ReferenceCase reference(13, 0);
  const edge::Rounding ellipse{kRightAngle, 20.0, 10.0, static_cast<double>(std::sin(kPi / 4.0L))};

  const edge::NearestPoint nearest = edge::nearest_to_apex(ellipse);

  // (1 - x / 20)^2 + (1 - y / 10)^2 = 1, x along the rake: place and tangent are at right angles, by bisection.
  long double low = 0.1L;
  long double high = 1.5L;
  for (int round = 0; round < 80; ++round) {
    const long double t = (low + high) / 2.0L;
    const long double along = 400.0L * (1.0L - std::cos(t)) * std::sin(t) - 100.0L * (1.0L - std::sin(t)) * std::cos(t);
    (along < 0.0L ? low : high) = t;
  }
  const long double x = 20.0L * (1.0L - std::cos(low));
  const long double y = 10.0L * (1.0L - std::sin(low));
  reference.compare("K", ellipse.s_gamma_um / ellipse.s_alpha_um, 2.0L, 2.0, 0.0);
  reference.compare("Delta_r", nearest.delta_r_um, std::hypot(x, y), 5.577801, 5e-7);
  reference.compare("phi", nearest.phi_deg, std::atan2(y, x) * 180.0L / kPi - 45.0L, 8.0836, 2e-4);
  reference.compare("r_min", edge::least_radius_um(ellipse), 10.0L * 10.0L / 20.0L, 5.0, 0.0);
}

TEST(EdgeCase, FourteenIsASharpWedgeBehindABox) {
  ReferenceCase reference(14, 161);
  LateralKernel kernel;
  kernel.weights.assign(9, 1.0 / 9.0);
  const edge::WindowProfile window(kernel, 1.0, 1.0, 1.0, 0.0);
  const auto right = static_cast<double>(kPi / 4.0L);
  // -abs(s), averaged over 9 um.
  const auto height = [](long double s) { return std::abs(s) >= 4.5L ? -std::abs(s) : -(s * s + 4.5L * 4.5L) / 9.0L; };
  edge::SectionData section;
  for (int i = -80; i <= 80; ++i) {
    section.s_um.push_back(i);
    section.h_um.push_back(static_cast<double>(height(i)));
    section.weight.push_back(1.0);
  }

  const edge::AveragedContour contour({0.0, 0.0, right, right, 0.0, 0.0, 0.0}, window);
  const EdgeOptions options;
  const auto lines = find_flank_lines(section, options);
  ASSERT_TRUE(lines.has_value());
  const edge::SectionFit fit = fit_section(section, window, edge::RoundingShape::kCircle, *lines, options);

  const double curvature = 2.0 * contour.height_um(0.0) - contour.height_um(0.5) - contour.height_um(-0.5);
  reference.compare("lowered", -contour.height_um(0.0), -height(0.0L), 2.25, 0.0);
  reference.compare("apparent radius", 0.25 / curvature, 9.0L / 2.0L, 4.5, 0.0);
  ASSERT_TRUE(fit.good);
  // Only its square shows in the section.
  reference.compare("radius", fit.model().signed_square_um2, 0.0L, 0.0, 0.0, 81.0);
}

TEST(FormCase, SeventeenIsASphereWithHoles) {
  ReferenceCase reference(17, 160 * 120);
  HeightField field = make_field(160, 120, 0.8, 1.1, [](double x, double y) {
    const long double dx = static_cast<long double>(x) - 70.0L;
    const long double dy = static_cast<long double>(y) - 60.0L;
    return static_cast<double>(std::sqrt(500.0L * 500.0L - dx * dx - dy * dy) - 488.0L);
  });
  punch_holes(field, 0.05, 1);

  const OperationReport report = remove_form(field, {FormKind::kSphere, 2}, {});

  ASSERT_FALSE(report.refused);
  reference.compare("R", report.find("radius_um")->value, 500.0L, 500.0, 0.0);
  EXPECT_NEAR(report.find("radius_um")->value, 500.0, 1e-9);
  double largest = 0.0;
  for (const double z : field.z_um.pixels()) largest = std::isnan(z) ? largest : std::max(largest, std::abs(z));
  reference.compare("residual", largest, 0.0L, 0.0, 0.0, 500.0);
}

}  // namespace
}  // namespace fvd::metrology::reference
