/// What the noise of points does to a groove's depth, predicted and drawn.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/uncertainty/budget.hpp"
#include "core/metrology/uncertainty/noise_map.hpp"
#include "tests/core/metrology/step/step_fields.hpp"

namespace fvd::metrology {
namespace {

constexpr double kDepth = 50.0;

HeightField groove(int rows) {
  return make_field(200, rows, 1.5, 1.5, [](double x, double y) {
    return 0.02 * x + 0.01 * y - (std::abs(x - 150.0) < 45.0 ? kDepth : 0.0);
  });
}

GrooveSettings with_edges() {
  GrooveSettings settings;
  settings.edges = GrooveEdges{105.0, 195.0};
  return settings;
}

/// Holes and a standard error that differs from place to place: larger in the groove.
HeightField measured_groove() {
  HeightField field = groove(63);
  punch_holes(field, 0.1, 21);
  set_uniform_sigma(field, 0.3);
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 70; column < 130; ++column) field.sigma_um.at(column, row) *= 2.0F;
  }
  field.kernel.weights.assign(9, 1.0 / 9.0);
  return field;
}

struct Draws {
  std::vector<double> mean_um;
  std::vector<double> areal_um;
};

Draws draw(const HeightField& field, int count, std::uint64_t seed) {
  NoiseMaps noise(field, seed);
  HeightField drawn = field.clone();
  drawn.sigma_um = Plane<float>();  // the uncertainty of a draw is not asked for
  Draws draws;
  for (int i = 0; i < count; ++i) {
    noise.add_to_heights(static_cast<std::uint64_t>(i), drawn.z_um);
    const GrooveStep step = given(iso5436_a1(drawn, with_edges()));
    draws.mean_um.push_back(step.mean.height_um);
    draws.areal_um.push_back(step.areal.height_um);
  }
  return draws;
}

double standard_deviation(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / (static_cast<double>(values.size()) - 1.0));
}

TEST(GrooveNoise, IsThatOfTheClosedFormForIndependentPoints) {
  // 60 points in a width; 9 rows are 9 traces of a row each.
  HeightField field = make_field(200, 9, 1.5, 1.5, [](double, double) { return 1.0; });
  set_uniform_sigma(field, 1.0);

  const GrooveStep step = given(iso5436_a1(field, with_edges()));

  ASSERT_TRUE(step.mean.noise.has_value() && step.areal.noise.has_value());
  EXPECT_NEAR(step.mean.noise->u * step.mean.noise->u, 3.75 / (60.0 * 9.0), 1e-12);
  EXPECT_NEAR(step.areal.noise->u * step.areal.noise->u, 3.75 / (60.0 * 9.0), 1e-12);
  EXPECT_NEAR(step.mean.noise->points_as_one, 1.0, 1e-12);
}

TEST(GrooveNoise, IsAbsentWithoutSigma) {
  const GrooveStep step = given(iso5436_a1(groove(63), with_edges()));

  EXPECT_FALSE(step.mean.noise.has_value());
  EXPECT_FALSE(step.areal.noise.has_value());
}

TEST(GrooveNoise, IsTheOneThatDrawsHave) {
  const HeightField field = measured_groove();
  const GrooveStep step = given(iso5436_a1(field, with_edges()));

  const Draws draws = draw(field, 100, 1);

  ASSERT_TRUE(step.mean.noise.has_value() && step.areal.noise.has_value());
  const double of_mean = standard_deviation(draws.mean_um) / step.mean.noise->u;
  const double of_areal = standard_deviation(draws.areal_um) / step.areal.noise->u;
  RecordProperty("ratio_of_mean", std::to_string(of_mean));
  RecordProperty("ratio_of_areal", std::to_string(of_areal));
  EXPECT_GT(of_mean, 0.75);
  EXPECT_LT(of_mean, 1.25);
  EXPECT_GT(of_areal, 0.75);
  EXPECT_LT(of_areal, 1.25);
  // Neighbours share a window of 81 points; at borders and beside holes somewhat less counts as one.
  EXPECT_GT(step.mean.noise->points_as_one, 45.0);
  EXPECT_LT(step.mean.noise->points_as_one, 81.0);
}

TEST(GrooveNoise, ExpandedCoversTheTruthAsOftenAsItSays) {
  const HeightField field = measured_groove();
  const GrooveStep step = given(iso5436_a1(field, with_edges()));
  ASSERT_TRUE(step.mean.noise.has_value() && step.areal.noise.has_value());
  const auto expanded = [](const LinearNoise& noise) {
    Budget budget;
    BudgetEntry entry;
    entry.source = "noise";
    entry.u = noise.u;
    budget.entries.push_back(entry);
    return combined(budget).value().expanded;
  };
  const auto covered = [](const std::vector<double>& values, double truth, double within) {
    return std::count_if(values.begin(), values.end(), [&](double value) { return std::abs(value - truth) <= within; });
  };

  const Draws draws = draw(field, 400, 2);

  const auto of_mean = covered(draws.mean_um, kDepth / std::sqrt(1.0004), expanded(*step.mean.noise));
  const auto of_areal = covered(draws.areal_um, kDepth / std::sqrt(1.0005), expanded(*step.areal.noise));
  RecordProperty("covered_by_mean", static_cast<int>(of_mean));
  RecordProperty("covered_by_areal", static_cast<int>(of_areal));
  EXPECT_GE(of_mean, 368);
  EXPECT_LE(of_mean, 392);
  EXPECT_GE(of_areal, 368);
  EXPECT_LE(of_areal, 392);
}

}  // namespace
}  // namespace fvd::metrology
