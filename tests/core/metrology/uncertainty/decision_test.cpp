#include "core/metrology/uncertainty/decision.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/metrology/uncertainty/linear_noise.hpp"
#include "core/metrology/uncertainty/noise_map.hpp"
#include "tests/core/metrology/uncertainty/noisy_fields.hpp"

namespace fvd::metrology {
namespace {

constexpr double kOneSided = 1.6448536269514722;  // 95 % of the normal distribution lie below it

CombinedUncertainty normal_u(double u, double k = 2.0) { return {u, kInfiniteDof, k, k * u, 0.95}; }

DecisionSettings by(DecisionRule rule) { return {rule, 0.95}; }

const Limits kBoth{49.9, 50.1};

TEST(Decision, PassesWhereConformityIsProbable) {
  // Limits 49.9 and 50.1 with u = 0.03: from 49.94935 to 50.05065, to the digits given.
  EXPECT_EQ(decide(49.94935, normal_u(0.03), kBoth).verdict, Verdict::kPass);
  EXPECT_EQ(decide(49.94934, normal_u(0.03), kBoth).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(50.05065, normal_u(0.03), kBoth).verdict, Verdict::kPass);
  EXPECT_EQ(decide(50.05066, normal_u(0.03), kBoth).verdict, Verdict::kUncertain);
}

TEST(Decision, FailsWhereNonConformityIsProbable) {
  EXPECT_EQ(decide(49.9 - 0.04934, normal_u(0.03), kBoth).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(49.9 - 0.04935, normal_u(0.03), kBoth).verdict, Verdict::kFail);
  EXPECT_EQ(decide(50.1 + 0.04934, normal_u(0.03), kBoth).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(50.1 + 0.04935, normal_u(0.03), kBoth).verdict, Verdict::kFail);
}

TEST(Decision, ByTheExpandedUncertaintyKeepsItFromEachLimit) {
  const DecisionSettings settings = by(DecisionRule::kGuardU);
  EXPECT_EQ(decide(49.960001, normal_u(0.03), kBoth, settings).verdict, Verdict::kPass);
  EXPECT_EQ(decide(49.959999, normal_u(0.03), kBoth, settings).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(50.039999, normal_u(0.03), kBoth, settings).verdict, Verdict::kPass);
  EXPECT_EQ(decide(50.040001, normal_u(0.03), kBoth, settings).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(49.840001, normal_u(0.03), kBoth, settings).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(49.839999, normal_u(0.03), kBoth, settings).verdict, Verdict::kFail);
  EXPECT_EQ(decide(50.160001, normal_u(0.03), kBoth, settings).verdict, Verdict::kFail);
}

TEST(Decision, OfOneLimitKeepsOneSidedGuard) {
  const Limits upper{std::nullopt, 10.0};
  const Limits lower{10.0, std::nullopt};
  EXPECT_EQ(decide(10.0 - 1e-6 - kOneSided * 0.5, normal_u(0.5), upper).verdict, Verdict::kPass);
  EXPECT_EQ(decide(10.0 + 1e-6 - kOneSided * 0.5, normal_u(0.5), upper).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(10.0 + 1e-6 + kOneSided * 0.5, normal_u(0.5), upper).verdict, Verdict::kFail);
  EXPECT_EQ(decide(10.0 + 1e-6 + kOneSided * 0.5, normal_u(0.5), lower).verdict, Verdict::kPass);
  EXPECT_EQ(decide(10.0 - 1e-6 - kOneSided * 0.5, normal_u(0.5), lower).verdict, Verdict::kFail);
}

TEST(Decision, OfFewDegreesOfFreedomKeepsTheGuardOfStudentsT) {
  const CombinedUncertainty uncertainty{0.5, 4.0, 2.776, 1.388, 0.95};
  const Limits upper{std::nullopt, 10.0};

  // The one-sided 95 % quantile for 4 degrees of freedom is 2.1318468.
  EXPECT_EQ(decide(10.0 - 2.13184 * 0.5, uncertainty, upper).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(10.0 - 2.13185 * 0.5, uncertainty, upper).verdict, Verdict::kPass);
}

TEST(Decision, HasTheExactProbabilityBetweenNarrowLimits) {
  // u = 0.06 in limits 0.2 apart: in the middle P = erf(0.1 / 0.06 / sqrt 2) = 0.904.
  const Decision middle = decide(50.0, normal_u(0.06), kBoth);
  ASSERT_TRUE(middle.conformity);
  EXPECT_NEAR(*middle.conformity, std::erf(0.1 / 0.06 / std::sqrt(2.0)), 1e-12);
  EXPECT_EQ(middle.verdict, Verdict::kUncertain);

  // Half the tolerance of 1.959964 u is just enough in the middle, where a one-sided guard would leave room beside it.
  EXPECT_EQ(decide(50.0, normal_u(0.1 / 1.95997), kBoth).verdict, Verdict::kPass);
  EXPECT_EQ(decide(50.0, normal_u(0.1 / 1.95996), kBoth).verdict, Verdict::kUncertain);
  EXPECT_EQ(decide(50.005, normal_u(0.1 / 1.95997), kBoth).verdict, Verdict::kUncertain);
}

TEST(Decision, OfThePlainValueLooksAtTheValueAlone) {
  const DecisionSettings settings = by(DecisionRule::kSimple);
  EXPECT_EQ(decide(49.9, normal_u(0.03), kBoth, settings).verdict, Verdict::kPass);
  EXPECT_EQ(decide(49.8999, normal_u(0.03), kBoth, settings).verdict, Verdict::kFail);
  EXPECT_EQ(decide(50.0, std::nullopt, kBoth, settings).verdict, Verdict::kPass);
}

TEST(Decision, WithoutUncertaintyIsUncertain) {
  for (const DecisionRule rule : {DecisionRule::kIso14253, DecisionRule::kGuardU}) {
    const Decision decision = decide(50.0, std::nullopt, kBoth, by(rule));

    EXPECT_EQ(decision.verdict, Verdict::kUncertain);
    EXPECT_FALSE(decision.conformity);
  }
}

TEST(Decision, WithoutAValueIsInvalid) {
  EXPECT_EQ(decide(std::nullopt, normal_u(0.03), kBoth).verdict, Verdict::kInvalid);
  EXPECT_EQ(decide(std::nullopt, normal_u(0.03), {}).verdict, Verdict::kInvalid);
  EXPECT_EQ(decide(std::numeric_limits<double>::quiet_NaN(), normal_u(0.03), kBoth).verdict, Verdict::kInvalid);
}

TEST(Decision, WithoutLimitsPasses) {
  EXPECT_EQ(decide(50.0, std::nullopt, {}).verdict, Verdict::kPass);
  EXPECT_FALSE(decide(50.0, normal_u(0.03), {}).conformity);
}

TEST(Decision, OfACertainValueHasNoGuard) {
  for (const DecisionRule rule : {DecisionRule::kIso14253, DecisionRule::kGuardU}) {
    EXPECT_EQ(decide(49.9, normal_u(0.0), kBoth, by(rule)).verdict, Verdict::kPass);
    EXPECT_EQ(decide(49.8999, normal_u(0.0), kBoth, by(rule)).verdict, Verdict::kFail);
  }
}

TEST(Decision, WarnsOfAnUncertaintyAboveAThirdOfTheTolerance) {
  EXPECT_FALSE(decide(50.0, normal_u(0.066), kBoth).u_above_third_of_tolerance);
  EXPECT_TRUE(decide(50.0, normal_u(0.067), kBoth).u_above_third_of_tolerance);
  EXPECT_FALSE(decide(50.0, normal_u(5.0), {49.9, std::nullopt}).u_above_third_of_tolerance);
}

TEST(Decision, OfAValueBelowTheNoiseDoesNotPassByALowerLimit) {
  const Limits lower{0.01, std::nullopt};
  const Limits upper{std::nullopt, 0.8};
  for (const DecisionRule rule : {DecisionRule::kIso14253, DecisionRule::kSimple, DecisionRule::kGuardU}) {
    const Decision held = decide(0.2, normal_u(0.001), lower, by(rule), true);

    EXPECT_EQ(held.verdict, Verdict::kUncertain);
    EXPECT_TRUE(held.held_back_below_noise);
    EXPECT_EQ(decide(0.2, normal_u(0.001), {0.01, 0.8}, by(rule), true).verdict, Verdict::kUncertain);
    EXPECT_EQ(decide(0.2, normal_u(0.001), upper, by(rule), true).verdict, Verdict::kPass);
    EXPECT_EQ(decide(0.2, normal_u(0.001), lower, by(rule), false).verdict, Verdict::kPass);
    EXPECT_FALSE(decide(0.005, normal_u(0.001), lower, by(rule), true).held_back_below_noise);
    EXPECT_EQ(decide(0.005, normal_u(0.001), lower, by(rule), true).verdict, Verdict::kFail);
  }
}

TEST(Decision, PassesOneInTwentyPartsThatAreExactlyAtALimit) {
  HeightField field = testing::uneven_field(30, 30, testing::box(9), true);
  for (double& z : field.z_um.pixels()) z = std::isnan(z) ? z : 50.0;
  WeightMap mean{5, 6, Plane<double>(20, 18)};
  int points = 0;
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 20; ++x) points += field.is_hole(5 + x, 6 + y) ? 0 : 1;
  }
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 20; ++x) mean.weights.at(x, y) = field.is_hole(5 + x, 6 + y) ? 0.0 : 1.0 / points;
  }
  const double u = linear_noise(field, mean)->u;
  NoiseMaps noise(field, 20);
  Plane<double> z_um(30, 30);
  int false_passes = 0;
  int false_fails = 0;

  for (int part = 0; part < 2000; ++part) {
    noise.add_to_heights(static_cast<std::uint64_t>(part), z_um);
    double value = 0.0;
    for (int y = 0; y < 18; ++y) {
      for (int x = 0; x < 20; ++x) {
        if (!field.is_hole(5 + x, 6 + y)) value += mean.weights.at(x, y) * z_um.at(5 + x, 6 + y);
      }
    }
    const Verdict verdict = decide(value, normal_u(u), {50.0, 50.0 + 40.0 * u}).verdict;
    false_passes += verdict == Verdict::kPass ? 1 : 0;
    false_fails += verdict == Verdict::kFail ? 1 : 0;
  }

  RecordProperty("false_pass_of_2000", false_passes);
  EXPECT_GE(false_passes, 70);
  EXPECT_LE(false_passes, 130);
  EXPECT_GE(false_fails, 70);
  EXPECT_LE(false_fails, 130);
}

}  // namespace
}  // namespace fvd::metrology
