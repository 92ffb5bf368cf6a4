/// Curves of known shape, sampled at heights that differ from those reported.

#include "core/focus/fit/stage_correction.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "gtest/gtest.h"

namespace fvd {
namespace {

constexpr double kStep_um = 8.0;
constexpr int kSamples = 40;
constexpr double kWidth_um = 40.0;  // of the curve

double curve(double z_um) {
  const double u = z_um / kWidth_um;
  return std::pow(1.0 + 4.0 * (std::sqrt(2.0) - 1.0) * u * u, -2.0);
}

struct Scene {
  double low_um = 40.0;  // surface heights between
  double high_um = 260.0;
  double noise = 0.01;  // of the peak
  std::vector<double> errors_um = std::vector<double>(kSamples);
};

std::vector<double> reported() {
  std::vector<double> z_um;
  for (int k = 0; k < kSamples; ++k) z_um.push_back(kStep_um * k);
  return z_um;
}

WorkerPool& pool() {
  static WorkerPool two(2);
  return two;
}

std::vector<CurveTuple> tuples_of(const Scene& scene) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> height(scene.low_um, scene.high_um);
  std::vector<CurveTuple> tuples;
  for (int i = 0; i < 10000; ++i) {
    const double z = height(random);
    std::vector<double> values;
    for (int k = 0; k < kSamples; ++k) {
      const double actual = kStep_um * k + scene.errors_um[static_cast<std::size_t>(k)];
      values.push_back(curve(actual - z) + scene.noise * normal(random));
    }
    const auto peak = std::max_element(values.begin() + 2, values.end() - 2);
    CurveTuple tuple;
    tuple.index = static_cast<int>(peak - values.begin());
    for (int j = -2; j <= 2; ++j) {
      tuple.share[static_cast<std::size_t>(j + 2)] = static_cast<float>(std::max(0.0, *(peak + j) / *peak));
    }
    tuple.noise = static_cast<float>(scene.noise / *peak);
    tuple.height_um = static_cast<float>(z);
    tuples.push_back(tuple);
  }
  return tuples;
}

TEST(StageCorrection, FindsWhatThePositionsWereOffBy) {
  Scene scene;
  for (int k = 0; k < kSamples; ++k) scene.errors_um[static_cast<std::size_t>(k)] = 0.8 * std::sin(1.3 * k);
  const StageCorrection found = solve_stage_correction(tuples_of(scene), reported(), pool());
  ASSERT_TRUE(found.applied) << found.reason;
  EXPECT_NEAR(found.rms_um, 0.8 / std::sqrt(2.0), 0.06);
  EXPECT_LT(found.standard_error_um, 0.1);
  for (std::size_t k = 8; k < 30; ++k) EXPECT_NEAR(found.offsets_um[k], scene.errors_um[k], 0.15) << k;
}

TEST(StageCorrection, DoesNotDependOnTheNumberOfThreads) {
  Scene scene;
  for (int k = 0; k < kSamples; ++k) scene.errors_um[static_cast<std::size_t>(k)] = 0.8 * std::sin(1.3 * k);
  const auto tuples = tuples_of(scene);
  WorkerPool one(1);
  WorkerPool five(5);
  const StageCorrection alone = solve_stage_correction(tuples, reported(), one);
  const StageCorrection together = solve_stage_correction(tuples, reported(), five);
  ASSERT_TRUE(alone.applied) << alone.reason;
  EXPECT_EQ(alone.offsets_um, together.offsets_um);
  EXPECT_EQ(alone.standard_error_um, together.standard_error_um);
}

TEST(StageCorrection, LeavesAGoodStageAlone) {
  const StageCorrection found = solve_stage_correction(tuples_of({}), reported(), pool());
  EXPECT_FALSE(found.applied);
  EXPECT_NE(found.reason.find("noise"), std::string::npos) << found.reason;
  EXPECT_TRUE(found.offsets_um.empty());
  EXPECT_LT(found.rms_um, 0.1);
}

TEST(StageCorrection, SaysWhyTheSurfaceTellsTooLittle) {
  Scene level;
  level.low_um = 100.0;
  level.high_um = 101.0;
  EXPECT_NE(solve_stage_correction(tuples_of(level), reported(), pool()).reason.find("spans"), std::string::npos);
  Scene good;
  auto few = tuples_of(good);
  few.resize(999);
  EXPECT_NE(solve_stage_correction(few, reported(), pool()).reason.find("999"), std::string::npos);
  auto steps = tuples_of(good);
  std::erase_if(steps, [](const CurveTuple& t) { return t.height_um > 80.0F && t.height_um < 220.0F; });
  EXPECT_NE(solve_stage_correction(steps, reported(), pool()).reason.find("covers"), std::string::npos);
  EXPECT_NE(solve_stage_correction(tuples_of(good), std::vector<double>(600), pool()).reason.find("600"),
            std::string::npos);
}

TEST(StageCorrection, RefusesHeightsThatDoNotRunOneWay) {
  const auto tuples = tuples_of({});
  auto turned = reported();
  std::swap(turned[20], turned[21]);
  EXPECT_NE(solve_stage_correction(tuples, turned, pool()).reason.find("one way"), std::string::npos);
  std::vector<double> there_and_back = reported();
  there_and_back.back() = there_and_back.front();
  EXPECT_NE(solve_stage_correction(tuples, there_and_back, pool()).reason.find("one way"), std::string::npos);
  const std::vector<double> equal(kSamples, 5.0);
  EXPECT_NE(solve_stage_correction(tuples, equal, pool()).reason.find("one way"), std::string::npos);
}

}  // namespace
}  // namespace fvd
