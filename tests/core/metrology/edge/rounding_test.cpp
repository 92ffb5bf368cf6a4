#include "core/metrology/edge/rounding.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace fvd::metrology::edge {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

TEST(Rounding, GivesACirclesLengthsAtNinetyAndSeventyDegrees) {
  const Rounding right = Rounding::circle(90.0 * kRadians, 10.0);
  const Rounding acute = Rounding::circle(70.0 * kRadians, 10.0);

  EXPECT_NEAR(right.s_gamma_um, 10.0, 1e-9);
  EXPECT_NEAR(acute.s_alpha_um, 14.28148, 5e-6);
  EXPECT_NEAR(nearest_to_apex(right).delta_r_um, 4.142136, 1e-6);
  EXPECT_NEAR(nearest_to_apex(acute).delta_r_um, 7.434468, 1e-6);
  EXPECT_NEAR(nearest_to_apex(acute).phi_deg, 0.0, 1e-4);
  EXPECT_NEAR(least_radius_um(right), 10.0, 1e-9);
  EXPECT_NEAR(least_radius_um(acute), 10.0, 1e-9);
}

TEST(Rounding, GivesAQuarterEllipsesLengths) {
  const Rounding ellipse{90.0 * kRadians, 20.0, 10.0, std::sin(45.0 * kRadians)};
  const NearestPoint nearest = nearest_to_apex(ellipse);

  // The ellipse itself: (1 - x / 20)^2 + (1 - y / 10)^2 = 1, x along the rake.
  // Its nearest point is where place and tangent are at right angles: by bisection over the ellipse's parameter.
  long double low = 0.1L;
  long double high = 1.5L;
  for (int round = 0; round < 80; ++round) {
    const long double t = (low + high) / 2.0L;
    const long double along = 400.0L * (1.0L - std::cos(t)) * std::sin(t) - 100.0L * (1.0L - std::sin(t)) * std::cos(t);
    (along < 0.0L ? low : high) = t;
  }
  const long double x = 20.0L * (1.0L - std::cos(low));
  const long double y = 10.0L * (1.0L - std::sin(low));
  const long double least = std::hypot(x, y);
  const long double angle = std::atan2(y, x) * 180.0L / std::numbers::pi_v<long double> - 45.0L;

  EXPECT_NEAR(nearest.delta_r_um, static_cast<double>(least), 1e-9);
  EXPECT_NEAR(nearest.delta_r_um, 5.577801, 1e-6);
  EXPECT_NEAR(nearest.phi_deg, static_cast<double>(angle), 1e-5);
  EXPECT_NEAR(nearest.phi_deg, 8.083429, 2e-6);
  EXPECT_NEAR(least_radius_um(ellipse), 5.0, 1e-9);
}

TEST(Rounding, TurnsPhisSignWhereTheClearanceIsTheLongerSide) {
  const Rounding waterfall{90.0 * kRadians, 10.0, 20.0, std::sin(45.0 * kRadians)};

  EXPECT_NEAR(nearest_to_apex(waterfall).phi_deg, -8.083429, 2e-6);
}

}  // namespace
}  // namespace fvd::metrology::edge
