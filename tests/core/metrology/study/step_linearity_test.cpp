#include "core/metrology/study/step_linearity.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/uncertainty/random_normal.hpp"

namespace fvd::metrology {
namespace {

ZAmplification amplified(std::span<const KnownStep> steps, double common = 0.0) {
  return std::get<ZAmplification>(z_amplification(steps, common));
}

bool refused(std::span<const KnownStep> steps) { return std::holds_alternative<StudyRefusal>(z_amplification(steps)); }

TEST(ZAmplification, IsMeasuredOverTrue) {
  const std::array steps{KnownStep{10.0, 0.01, 9.98, 0.02}, KnownStep{50.0, 0.02, 49.9, 0.02},
                         KnownStep{-100.0, 0.03, -99.8, 0.02}};

  const ZAmplification result = amplified(steps);

  EXPECT_NEAR(result.alpha_z, 0.998, 1e-14);
  EXPECT_NEAR(result.linearity_um, 0.0, 1e-12);
  EXPECT_NEAR(result.reduced_chi_squared, 0.0, 1e-12);
}

TEST(ZAmplification, WeighsStepsByTheirUncertainties) {
  // u = 0.05 and 0.1, so the weights are 400 and 100: alpha = (400 * 1.02 + 100 * 0.98 * 1) / 500 for heights of 1.
  const std::array steps{KnownStep{1.0, 0.03, 1.02, 0.04}, KnownStep{1.0, 0.08, 0.98, 0.06}};

  const ZAmplification result = amplified(steps);

  EXPECT_NEAR(result.alpha_z, 1.012, 1e-12);
  EXPECT_NEAR(result.u_alpha_z, 1.0 / std::sqrt(500.0), 1e-12);
  ASSERT_EQ(result.residuals_um.size(), 2U);
  EXPECT_NEAR(result.residuals_um[0], 0.008, 1e-12);
  EXPECT_NEAR(result.residuals_um[1], -0.032, 1e-12);
  EXPECT_NEAR(result.linearity_um, 0.032, 1e-12);
  EXPECT_NEAR(result.u_linearity_um, 0.1, 1e-12);
  EXPECT_NEAR(result.reduced_chi_squared, 400.0 * 0.008 * 0.008 + 100.0 * 0.032 * 0.032, 1e-10);
}

TEST(ZAmplification, WeighsHighStepsMore) {
  const std::array steps{KnownStep{1.0, 0.1, 1.1, 0.0}, KnownStep{3.0, 0.1, 3.0, 0.0}};

  EXPECT_NEAR(amplified(steps).alpha_z, (1.1 + 9.0) / 10.0, 1e-12);
}

TEST(ZAmplification, DoesNotAverageWhatAllCertificatesShare) {
  const std::array steps{KnownStep{30.0, 0.03, 60.0, 0.04}, KnownStep{40.0, 0.03, 80.0, 0.04}};

  const ZAmplification result = amplified(steps, 0.002);

  // From the steps 0.05 / 50 = 0.001, shared 2 * 0.002.
  EXPECT_NEAR(result.u_alpha_z, std::hypot(0.001, 0.004), 1e-12);
}

TEST(ZAmplification, OfOneStepHasNoScatter) {
  const std::array steps{KnownStep{50.0, 0.03, 49.5, 0.04}};

  const ZAmplification result = amplified(steps);

  EXPECT_NEAR(result.alpha_z, 0.99, 1e-14);
  EXPECT_NEAR(result.u_alpha_z, 0.001, 1e-14);
  EXPECT_EQ(result.reduced_chi_squared, 0.0);
  EXPECT_NEAR(result.u_linearity_um, 0.05, 1e-14);
}

TEST(ZAmplification, WithoutStatedUncertaintiesTakesThatOfTheScatter) {
  const std::array steps{KnownStep{1.0, 0.0, 1.02, 0.0}, KnownStep{1.0, 0.0, 0.98, 0.0}};

  const ZAmplification result = amplified(steps);

  EXPECT_NEAR(result.alpha_z, 1.0, 1e-14);
  EXPECT_NEAR(result.u_alpha_z, 0.02, 1e-12);  // sd 0.02 sqrt 2 of each, over sqrt 2
  EXPECT_EQ(result.reduced_chi_squared, 0.0);
}

TEST(ZAmplification, HasTheUncertaintyThatDrawsShow) {
  const std::array<double, 3> heights{5.0, 20.0, 80.0};
  RandomNormal random(8);
  double mean_chi = 0.0;
  double squares = 0.0;
  double u = 0.0;

  for (int draw = 0; draw < 2000; ++draw) {
    std::array<KnownStep, 3> steps;
    for (std::size_t i = 0; i < 3; ++i) {
      const double u_measured = 0.02 + 0.0005 * heights[i];
      steps[i] = {heights[i], 0.01, heights[i] + u_measured * random.normal() + 0.01 * random.normal(), u_measured};
    }
    const ZAmplification result = amplified(steps);
    squares += std::pow(result.alpha_z - 1.0, 2) / 2000.0;
    mean_chi += result.reduced_chi_squared / 2000.0;
    u = result.u_alpha_z;
  }

  EXPECT_NEAR(std::sqrt(squares) / u, 1.0, 0.064);  // four standard errors
  EXPECT_NEAR(mean_chi, 1.0, 0.09);
}

TEST(ZAmplification, IsRefusedWhereStepsCannotTellIt) {
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused(std::array{KnownStep{0.0, 0.1, 0.1, 0.1}}));
  EXPECT_TRUE(refused(std::array{KnownStep{10.0, 0.0, 10.0, 0.0}}));
  EXPECT_TRUE(refused(std::array{KnownStep{10.0, 0.1, 10.0, 0.1}, KnownStep{20.0, 0.0, 20.0, 0.0}}));
  EXPECT_FALSE(refused(std::array{KnownStep{10.0, 0.1, 10.0, 0.0}, KnownStep{0.0, 0.0, 0.0, 0.1}}));
}

TEST(ZAmplification, TakesFiniteFiguresOnly) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(z_amplification(std::array{KnownStep{10.0, 0.1, nan, 0.1}})), Error);
  EXPECT_THROW(static_cast<void>(z_amplification(std::array{KnownStep{10.0, -0.1, 10.0, 0.1}})), Error);
  EXPECT_THROW(static_cast<void>(z_amplification(std::array{KnownStep{10.0, 0.1, 10.0, 0.1}}, -1.0)), Error);
}

TEST(ZLinearity, IsTheLargestDeviationFromTheMean) {
  // Heights 50 + 0.002 (z - 100) with 0.01, -0.02, 0.01 on top; z 0, 100, 200.
  const std::array steps{StepAtZ{0.0, 49.81}, StepAtZ{100.0, 49.98}, StepAtZ{200.0, 50.21}};

  const ZLinearity result = std::get<ZLinearity>(z_linearity(steps));

  EXPECT_NEAR(result.mean_um, 50.0, 1e-12);
  EXPECT_NEAR(result.linearity_um, 0.21, 1e-12);
  EXPECT_NEAR(result.trend_um_per_mm, 2.0, 1e-9);
  EXPECT_NEAR(result.sd_um, std::sqrt((0.19 * 0.19 + 0.02 * 0.02 + 0.21 * 0.21) / 2.0), 1e-12);
  ASSERT_EQ(result.deviations_um.size(), 3U);
  EXPECT_NEAR(result.deviations_um[0], -0.19, 1e-12);
  EXPECT_NEAR(result.deviations_um[1], -0.02, 1e-12);
}

TEST(ZLinearity, NeedsTwoPlaces) {
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(z_linearity({})));
  const std::array same{StepAtZ{5.0, 49.81}, StepAtZ{5.0, 49.98}};
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(z_linearity(same)));
}

}  // namespace
}  // namespace fvd::metrology
