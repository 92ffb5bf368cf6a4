#include "sim/artefact/wedge_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gtest/gtest.h"

namespace fvd::sim {
namespace {

CuttingEdge circle(double radius_um, double beta_deg) {
  CuttingEdge edge;
  edge.radius_um = radius_um;
  edge.beta_deg = beta_deg;
  return edge;
}

CuttingEdge conic(double s_gamma_um, double s_alpha_um, double beta_deg = 90.0) {
  CuttingEdge edge;
  edge.rounding = Rounding::kConic;
  edge.s_gamma_um = s_gamma_um;
  edge.s_alpha_um = s_alpha_um;
  edge.beta_deg = beta_deg;
  return edge;
}

/// Radius of the circle through three points of the contour.
double radius_through(const WedgeSection& section, double s1, double s2, double s3) {
  const double h1 = section.height_um(s1);
  const double h2 = section.height_um(s2);
  const double h3 = section.height_um(s3);
  const double a = std::hypot(s2 - s1, h2 - h1);
  const double b = std::hypot(s3 - s2, h3 - h2);
  const double c = std::hypot(s3 - s1, h3 - h1);
  return a * b * c / (2.0 * std::abs((s2 - s1) * (h3 - h1) - (s3 - s1) * (h2 - h1)));
}

/// Least distance from the apex to the contour with a notch, by trying.
double least_distance(const WedgeSection& section, double notch_um) {
  double least = 1e9;
  for (int i = -400000; i <= 400000; ++i) {
    const double s = i * 1e-4;
    least = std::min(least, std::hypot(s, section.height_um(s, notch_um)));
  }
  return least;
}

TEST(WedgeSection, IsSharpWithoutARounding) {
  CuttingEdge edge;
  edge.rounding = Rounding::kSharp;

  const WedgeSection section(edge, 0.0);

  for (const double s : {-50.0, -0.1, 0.0, 3.0}) EXPECT_NEAR(section.height_um(s), -std::abs(s), 1e-12);
  EXPECT_EQ(section.truth().radius_um, 0.0);
  EXPECT_EQ(section.truth().delta_r_um, 0.0);
  EXPECT_FALSE(section.truth().k.has_value());
  EXPECT_FALSE(section.truth().phi_deg.has_value());
}

TEST(WedgeSection, IsACircleBetweenItsFlanks) {
  for (const double lean_deg : {0.0, 12.0, -20.0}) {
    const WedgeSection right(circle(10.0, 90.0), lean_deg);
    const WedgeSection acute(circle(10.0, 70.0), lean_deg);

    EXPECT_NEAR(radius_through(right, -4.0, 0.0, 4.0), 10.0, 1e-10) << lean_deg;
    EXPECT_NEAR(radius_through(right, -2.0, 1.0, 2.5), 10.0, 1e-9) << lean_deg;
    EXPECT_NEAR(radius_through(acute, -3.0, 0.0, 3.0), 10.0, 1e-10) << lean_deg;
    EXPECT_NEAR(right.truth().r_min_um, 10.0, 1e-10);
  }
}

TEST(WedgeSection, TellsTheDimensionsOfACircle) {
  const WedgeTruth right = WedgeSection(circle(10.0, 90.0), 0.0).truth();
  const WedgeTruth acute = WedgeSection(circle(10.0, 70.0), 7.0).truth();

  EXPECT_NEAR(right.s_gamma_um, 10.0, 1e-12);
  EXPECT_NEAR(right.delta_r_um, 4.142136, 5e-7);
  EXPECT_NEAR(acute.s_gamma_um, 14.28148, 5e-6);
  EXPECT_NEAR(acute.s_alpha_um, 14.28148, 5e-6);
  EXPECT_NEAR(acute.delta_r_um, 7.434468, 5e-7);
  EXPECT_NEAR(acute.k.value(), 1.0, 1e-12);
  EXPECT_NEAR(acute.phi_deg.value(), 0.0, 1e-9);
}

TEST(WedgeSection, IsAQuarterOfAnEllipseWithUnequalDistances) {
  const WedgeSection section(conic(20.0, 10.0), 0.0);

  const WedgeTruth& truth = section.truth();
  EXPECT_NEAR(truth.k.value(), 2.0, 1e-12);
  EXPECT_NEAR(truth.delta_r_um, 5.577801, 5e-7);
  EXPECT_NEAR(truth.phi_deg.value(), 8.0836, 2e-4);
  EXPECT_NEAR(truth.r_min_um, 5.0, 1e-9);
  EXPECT_FALSE(truth.radius_um.has_value());
  for (double s = -14.0; s <= 7.0; s += 0.5) {
    const double h = section.height_um(s);
    const double along_rake = (-s - h) / std::numbers::sqrt2;
    const double along_clearance = (s - h) / std::numbers::sqrt2;
    EXPECT_NEAR(std::pow(along_rake / 20.0 - 1.0, 2) + std::pow(along_clearance / 10.0 - 1.0, 2), 1.0, 1e-12) << s;
  }
}

TEST(WedgeSection, MirrorsIfTheDistancesChangePlaces) {
  const WedgeSection trumpet(conic(40.0, 20.0, 75.0), 5.0);
  const WedgeSection waterfall(conic(20.0, 40.0, 75.0), -5.0);

  for (double s = -60.0; s <= 60.0; s += 1.5) EXPECT_NEAR(trumpet.height_um(s), waterfall.height_um(-s), 1e-11);
  EXPECT_NEAR(trumpet.truth().phi_deg.value(), -waterfall.truth().phi_deg.value(), 1e-9);
  EXPECT_NEAR(trumpet.truth().k.value() * waterfall.truth().k.value(), 1.0, 1e-12);
}

TEST(WedgeSection, LeavesTheFlanksAtItsDistances) {
  const double lean_deg = 11.0;
  const WedgeSection section(conic(30.0, 12.0, 80.0), lean_deg);
  const double rake = (40.0 - lean_deg) * std::numbers::pi / 180.0;       // against the vertical
  const double clearance = (40.0 + lean_deg) * std::numbers::pi / 180.0;  // ...
  const double from_s = -30.0 * std::sin(rake);
  const double to_s = 12.0 * std::sin(clearance);

  const auto below_rake = [&](double s) { return s / std::tan(rake) - section.height_um(s); };
  const auto below_clearance = [&](double s) { return -s / std::tan(clearance) - section.height_um(s); };
  EXPECT_NEAR(below_rake(-100.0), 0.0, 1e-12);
  EXPECT_NEAR(below_rake(from_s - 1e-9), 0.0, 1e-12);
  EXPECT_NEAR(below_rake(from_s + 1e-4), 0.0, 1e-8) << "tangent";
  EXPECT_GT(below_rake(from_s + 0.2), 1e-4);
  EXPECT_NEAR(below_clearance(100.0), 0.0, 1e-12);
  EXPECT_NEAR(below_clearance(to_s + 1e-9), 0.0, 1e-12);
  EXPECT_NEAR(below_clearance(to_s - 1e-4), 0.0, 1e-8) << "tangent";
  EXPECT_GT(below_clearance(to_s - 0.2), 1e-4);
}

TEST(WedgeSection, TakesItsShoulderFromTheWeight) {
  CuttingEdge edge = conic(20.0, 20.0);
  for (const double weight : {0.3, 1.0, 4.0}) {
    edge.weight = weight;

    const WedgeSection section(edge, 0.0);

    EXPECT_NEAR(section.height_um(0.0), -20.0 / std::numbers::sqrt2 / (1.0 + weight), 1e-12) << weight;
    EXPECT_NEAR(section.truth().delta_r_um, least_distance(section, 0.0), 1e-6) << weight;
  }
}

TEST(WedgeSection, HasTheLeastRadiusThatItsPointsShow) {
  CuttingEdge edge = conic(25.0, 15.0, 100.0);
  edge.weight = 1.4;
  const WedgeSection section(edge, 6.0);
  double least = 1e9;

  for (double s = -15.0; s <= 12.0; s += 0.01) {
    least = std::min(least, radius_through(section, s - 0.02, s, s + 0.02));
  }

  EXPECT_NEAR(section.truth().r_min_um, least, 1e-3 * least);
}

TEST(WedgeSection, TakesANotchAwayFromTheApexByItsDepth) {
  for (const double lean_deg : {0.0, 15.0}) {
    for (const CuttingEdge& edge : {circle(10.0, 90.0), conic(40.0, 20.0), conic(10.0, 25.0, 70.0)}) {
      const WedgeSection section(edge, lean_deg);
      const double sound = section.truth().delta_r_um;

      EXPECT_NEAR(least_distance(section, 0.0), sound, 1e-6);
      EXPECT_NEAR(least_distance(section, 4.0), sound + 4.0, 1e-6);
      EXPECT_NEAR(section.height_um(60.0, 4.0), section.height_um(60.0), 1e-12) << "the flanks stay";
    }
  }
}

}  // namespace
}  // namespace fvd::sim
