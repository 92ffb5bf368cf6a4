#include "core/stage/stage_fit.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/core/stage/synthetic_stage.hpp"

namespace fvd {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct Fitted {
  StageFit fit;
  std::vector<std::string> caveats;
};

Fitted fitted(const std::vector<StagePoint>& points, const StageReportOptions& options = test::scale_options()) {
  Fitted result;
  result.fit = fit_stage(points, options, result.caveats);
  return result;
}

double angle_between(double a_deg, double b_deg) { return std::abs(std::remainder(a_deg - b_deg, 360.0)); }

TEST(StageFit, FindsEveryPlantedTermAtOnce) {
  for (const double phase_deg : {-170.0, -60.0, 0.0, 40.0, 179.0}) {
    test::SyntheticStage stage;
    stage.phase_deg = phase_deg;
    const auto [fit, caveats] = fitted(test::synthetic_points(stage));
    ASSERT_TRUE(fit.alpha_z && fit.lead && fit.reversal_um && fit.drift_um_per_min) << phase_deg;
    EXPECT_NEAR(fit.alpha_z->value, stage.alpha_z, 1e-5);
    EXPECT_NEAR(fit.lead->amplitude_um.value, stage.amplitude_um, 0.02 * stage.amplitude_um);
    EXPECT_LT(angle_between(fit.lead->phase_deg, phase_deg), 2.0);
    EXPECT_NEAR(fit.reversal_um->value, stage.reversal_um, 0.01);
    EXPECT_NEAR(fit.drift_um_per_min->value, stage.drift_um_per_min, 0.02 * stage.drift_um_per_min);
    EXPECT_NEAR(fit.residual_rms_um, stage.noise_um, 0.1 * stage.noise_um);
    const double drift_to_mean = stage.drift_um_per_min * fit.mean_time_s / 60.0;
    EXPECT_NEAR(fit.offset_um, stage.offset_um + drift_to_mean, 0.02);
    EXPECT_THAT(caveats, Contains(HasSubstr("temperature is not known")));
  }
}

TEST(StageFit, StandardErrorsAreThoseOfRepeatedRuns) {
  constexpr int kRepeats = 60;
  double squares_alpha = 0.0;
  double squares_amplitude = 0.0;
  double said_alpha = 0.0;
  double said_amplitude = 0.0;
  for (unsigned seed = 0; seed < kRepeats; ++seed) {
    test::SyntheticStage stage;
    stage.seed = seed;
    const auto fit = fitted(test::synthetic_points(stage)).fit;
    squares_alpha += std::pow(fit.alpha_z->value - stage.alpha_z, 2) / kRepeats;
    squares_amplitude += std::pow(fit.lead->amplitude_um.value - stage.amplitude_um, 2) / kRepeats;
    said_alpha += fit.alpha_z->standard_error.value() / kRepeats;
    said_amplitude += fit.lead->amplitude_um.standard_error.value() / kRepeats;
  }
  EXPECT_NEAR(std::sqrt(squares_alpha) / said_alpha, 1.0, 0.3);
  EXPECT_NEAR(std::sqrt(squares_amplitude) / said_amplitude, 1.0, 0.3);
}

TEST(StageFit, GivesBackTheCurveItWasFittedTo) {
  test::SyntheticStage stage;
  stage.noise_um = 0.0;
  stage.drift_um_per_min = 0.0;
  const auto points = test::synthetic_points(stage);
  const auto fit = fitted(points).fit;
  for (const StagePoint& p : points) {
    ASSERT_NEAR(fitted_error_um(fit, p.quantised_um, p.direction), p.measured_um - p.quantised_um, 1e-6);
    ASSERT_NEAR(fitted_drift_um(fit, p), 0.0, 1e-6);
  }
}

TEST(StageFit, TellsTemperatureFromTime) {
  test::SyntheticStage stage;
  stage.drift_um_per_k = 3.5;
  stage.temperature_c = [](double time_s) { return 20.0 + std::sin(time_s / 25.0); };
  const auto [fit, caveats] = fitted(test::synthetic_points(stage));
  ASSERT_TRUE(fit.drift_um_per_k && fit.drift_um_per_min);
  EXPECT_NEAR(fit.drift_um_per_k->value, 3.5, 0.05 * 3.5);
  EXPECT_NEAR(fit.drift_um_per_min->value, 0.25, 0.05 * 0.25);
  EXPECT_FALSE(fit.per_kelvin_from_rates);
  EXPECT_THAT(caveats, IsEmpty());
}

TEST(StageFit, DividesTheRatesWhereTemperatureRunsWithTime) {
  test::SyntheticStage stage;
  stage.drift_um_per_min = 0.0;
  stage.drift_um_per_k = 2.0;
  stage.temperature_c = [](double time_s) { return 20.0 + 0.3 * time_s / 60.0; };
  const auto [fit, caveats] = fitted(test::synthetic_points(stage));
  ASSERT_TRUE(fit.drift_um_per_k && fit.drift_um_per_min);
  EXPECT_TRUE(fit.per_kelvin_from_rates);
  EXPECT_NEAR(fit.drift_um_per_min->value, 0.6, 0.05 * 0.6);
  EXPECT_NEAR(fit.drift_um_per_k->value, 2.0, 0.05 * 2.0);
  EXPECT_THAT(caveats, Contains(HasSubstr("collinear with time")));
  // The drift is counted once where it is taken off.
  StagePoint later = test::synthetic_points(stage).back();
  EXPECT_NEAR(fitted_drift_um(fit, later), 0.6 * (later.time_s - fit.mean_time_s) / 60.0, 0.05);
}

TEST(StageFit, DoesNotFitATemperatureThatStoodStill) {
  test::SyntheticStage stage;
  stage.temperature_c = [](double time_s) { return 20.0 + 0.1 * std::sin(time_s); };
  const auto [fit, caveats] = fitted(test::synthetic_points(stage));
  EXPECT_FALSE(fit.drift_um_per_k);
  EXPECT_THAT(caveats, Contains(HasSubstr("less than 0.5 K")));
}

TEST(StageFit, OnePassOneWayCannotTellDriftFromSlope) {
  test::SyntheticStage stage;
  stage.runs = 1;
  stage.down = false;
  const auto [fit, caveats] = fitted(test::synthetic_points(stage));
  EXPECT_FALSE(fit.drift_um_per_min);
  EXPECT_FALSE(fit.reversal_um);
  ASSERT_TRUE(fit.alpha_z);
  EXPECT_THAT(caveats, Contains(HasSubstr("drift is not distinguishable")));
}

TEST(StageFit, OnePassWithRisingTemperatureBlamesNoTerm) {
  test::SyntheticStage stage;
  stage.runs = 1;
  stage.down = false;
  stage.drift_um_per_k = 2.0;
  stage.temperature_c = [](double time_s) { return 20.0 + 2.0 * time_s / 60.0; };
  const auto [fit, caveats] = fitted(test::synthetic_points(stage));
  EXPECT_FALSE(fit.drift_um_per_min || fit.drift_um_per_k);
  EXPECT_THAT(caveats, Contains(HasSubstr("temperature is not distinguishable")));
}

TEST(StageFit, ALeadThatThePositionsCannotShowIsLeftOut) {
  test::SyntheticStage stage;
  stage.range_um = 6000.0;
  stage.positions = 7;  // one a lead: the lead error is the same everywhere
  const auto once = fitted(test::synthetic_points(stage));
  EXPECT_FALSE(once.fit.lead);
  EXPECT_THAT(once.caveats, Contains(HasSubstr("do not resolve the screw lead")));
  stage.positions = 13;  // two a lead: a sine and a cosine cannot be told apart
  EXPECT_FALSE(fitted(test::synthetic_points(stage)).fit.lead);
  stage.positions = 19;
  const auto three = fitted(test::synthetic_points(stage));
  ASSERT_TRUE(three.fit.lead);
  EXPECT_NEAR(three.fit.lead->amplitude_um.value, 0.3, 0.02);
}

TEST(StageFit, ADriftIsSeenAtOnePosition) {
  test::SyntheticStage stage;
  stage.positions = 1;
  stage.runs = 200;
  stage.down = false;
  const auto [fit, caveats] = fitted(test::synthetic_points(stage));
  EXPECT_FALSE(fit.alpha_z);
  EXPECT_FALSE(fit.lead);
  ASSERT_TRUE(fit.drift_um_per_min);
  EXPECT_NEAR(fit.drift_um_per_min->value, 0.25, 0.05 * 0.25);
  EXPECT_THAT(caveats, Contains(HasSubstr("all points are at one position")));
}

TEST(AlphaZBiasBound, IsTheWorstPhaseOfASine) {
  EXPECT_NEAR(alpha_z_bias_bound(0.3, 1000.0, 1000.0), 6 * 0.3 / (M_PI * 1000.0), 1e-12);
  EXPECT_NEAR(alpha_z_bias_bound(0.3, 1000.0, 3000.0), 6 * 0.3 / (M_PI * 9000.0), 1e-12);
}

}  // namespace
}  // namespace fvd
