#include "core/metrology/study/capability.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

struct Study {
  GaugeType1 type1;
  GaugeRr rr;
  CapabilityInputs inputs;
};

/// Every contribution another power of two, so that one left out or twice in shows.
Study powers_of_two() {
  Study study;
  study.type1.sd = 1.0;
  study.type1.bias = -2.0 * std::sqrt(3.0);
  study.rr.ev = 0.5;
  study.rr.av = 4.0;
  study.rr.interaction = 8.0;
  study.inputs = {16.0, 32.0, 64.0, 128.0, 256.0, 512.0, 1024.0, 1e5, 2.0};
  return study;
}

double power_sum(std::initializer_list<int> powers) {
  double sum = 0.0;
  for (const int power : powers) sum += std::pow(4.0, power);
  return sum;
}

TEST(Capability, AddsWhatTheSystemAndTheProcessHave) {
  const Study study = powers_of_two();

  const Capability result = capability(study.type1, std::nullopt, study.rr, study.inputs);

  // Calibration 16, scatter 1, bias 2, linearity 32, rest of the system 512.
  EXPECT_NEAR(result.u_system * result.u_system, power_sum({4, 0, 1, 5, 9}), 1e-8);
  EXPECT_NEAR(result.u_process * result.u_process, power_sum({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), 1e-8);
  EXPECT_NEAR(result.q_system_percent, 100.0 * 4.0 * result.u_system / 1e5, 1e-12);
  EXPECT_NEAR(result.q_process_percent, 100.0 * 4.0 * result.u_process / 1e5, 1e-12);
}

TEST(Capability, TakesTheLargestOfScatterAndResolution) {
  Study study = powers_of_two();
  study.inputs = {};
  study.inputs.tolerance = 100.0;
  study.type1.bias = 0.0;
  study.rr.av = 0.0;
  study.rr.interaction = 0.0;

  const Capability by_scatter = capability(study.type1, 0.1, study.rr, study.inputs);
  const Capability by_resolution = capability(study.type1, 3.0 * std::sqrt(12.0), study.rr, study.inputs);
  study.rr.ev = 2.0;
  const Capability by_parts = capability(study.type1, 0.1, study.rr, study.inputs);

  EXPECT_NEAR(by_scatter.u_system, 1.0, 1e-12);
  EXPECT_NEAR(by_scatter.u_process, 1.0, 1e-12);
  EXPECT_NEAR(by_resolution.u_system, 3.0, 1e-12);
  EXPECT_NEAR(by_resolution.u_process, 3.0, 1e-12);
  EXPECT_NEAR(by_parts.u_system, 1.0, 1e-12);
  EXPECT_NEAR(by_parts.u_process, 2.0, 1e-12);
}

TEST(Capability, IsGivenUpToFifteenAndThirtyPercent) {
  GaugeType1 type1;
  type1.sd = 1.0;
  GaugeRr rr;
  CapabilityInputs inputs;
  const auto with_tolerance = [&](double tolerance) {
    inputs.tolerance = tolerance;
    return capability(type1, std::nullopt, rr, inputs);
  };

  EXPECT_TRUE(with_tolerance(26.67).system_capable);  // 400 / 15 = 26.667
  EXPECT_FALSE(with_tolerance(26.66).system_capable);
  EXPECT_TRUE(with_tolerance(13.34).process_capable);
  EXPECT_FALSE(with_tolerance(13.33).process_capable);
}

TEST(Capability, NeedsATolerance) { EXPECT_THROW(static_cast<void>(capability({}, std::nullopt, {}, {})), Error); }

}  // namespace
}  // namespace fvd::metrology
