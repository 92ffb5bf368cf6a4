#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/filter/profile_filter.hpp"
#include "core/metrology/filter/robust_rounds.hpp"
#include "core/metrology/filter/surface_filter.hpp"
#include "tests/core/metrology/filter/local_fit_reference.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

Plane<double> noisy_with_grooves(int width, int height) {
  std::mt19937 random(17);
  std::normal_distribution<double> noise(0.0, 0.2);
  Plane<double> z(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) z.at(x, y) = noise(random) + 0.05 * x - (x % 11 == 5 ? 4.0 : 0.0);
  }
  z.at(width / 2, height / 2) = kHole;
  return z;
}

/// The rounds of ISO 16610-71 once more, on local fits from their definition.
Plane<double> robust_reference(const Plane<double>& z, int order, double nesting_px, int& rounds) {
  Plane<double> weights(z.width(), z.height(), 1.0);
  Plane<double> smooth(z.width(), z.height(), kHole);
  const double deviation = reference_deviation(order, nesting_px);
  double before = 0.0;
  for (rounds = 1;; ++rounds) {
    std::vector<double> residuals;
    for (int y = 0; y < z.height(); ++y) {
      for (int x = 0; x < z.width(); ++x) {
        if (std::isnan(z.at(x, y))) continue;
        smooth.at(x, y) = local_fit(z, weights, x, y, order, deviation, deviation);
        residuals.push_back(std::abs(z.at(x, y) - smooth.at(x, y)));
      }
    }
    std::sort(residuals.begin(), residuals.end());
    const std::size_t n = residuals.size();
    const double cut = 4.4478 * 0.5 * (residuals[(n - 1) / 2] + residuals[n / 2]);
    if (std::abs(cut - before) < 1e-4 * before || rounds == 20) return smooth;
    before = cut;
    for (std::size_t i = 0; i < weights.pixels().size(); ++i) {
      const double ratio = (z.pixels()[i] - smooth.pixels()[i]) / cut;
      weights.pixels()[i] = std::abs(ratio) < 1.0 ? std::pow(1.0 - ratio * ratio, 2) : 0.0;
    }
  }
}

TEST(RobustFilter, MakesTheRoundsOfItsDefinition) {
  const HeightField field{noisy_with_grooves(24, 16), {}, 1.0, 1.0, {}};
  const FilterMethod methods[] = {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1,
                                  FilterMethod::kGaussianRegression2};
  for (int order = 0; order < 3; ++order) {
    int rounds = 0;
    const Plane<double> expected = robust_reference(field.z_um, order, 7.0, rounds);

    const FilteredSurface smooth =
        filter_surface(field, {.side = FilterSide::kS, .nesting_um = 7.0, .method = methods[order], .robust = true});

    EXPECT_EQ(smooth.report.rounds, rounds);
    EXPECT_TRUE(smooth.report.converged);
    EXPECT_GT(*smooth.report.cut_um, 0.3);
    for (std::size_t i = 0; i < expected.pixels().size(); ++i) {
      const double value = smooth.surface.z_um.pixels()[i];
      if (!std::isnan(value)) {
        EXPECT_NEAR(value, expected.pixels()[i], 1e-4);
      }
    }
    EXPECT_LT(smooth.report.points_lost, 40u);
  }
}

TEST(RobustFilter, DoesNotSeeGroovesInAProfile) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.05);
  std::vector<double> z;
  for (int i = 0; i < 400; ++i) z.push_back(0.0002 * i * i + noise(random) - (i % 40 < 5 ? 10.0 : 0.0));

  FilterSettings settings{.side = FilterSide::kS, .nesting_um = 100.0, .method = FilterMethod::kGaussianRegression2};
  const FilteredProfile plain = filter_profile(z, 1.0, settings);
  settings.robust = true;
  const FilteredProfile robust = filter_profile(z, 1.0, settings);

  EXPECT_LT(plain.z_um[200], 0.0002 * 200 * 200 - 0.8);
  for (std::size_t i = 0; i < 400; ++i) EXPECT_NEAR(robust.z_um[i], 0.0002 * static_cast<double>(i * i), 0.1);
  EXPECT_GT(robust.report.rounds, 2);
  EXPECT_TRUE(robust.report.converged);
}

TEST(RobustFilter, FindsAnExactParaboloidBelowSpikes) {
  HeightField field{Plane<double>(80, 80), {}, 1.0, 1.0, {}};
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) field.z_um.at(x, y) = 0.01 * x * x - 0.02 * x * y;
  }
  field.z_um.at(30, 40) += 100.0;
  field.z_um.at(70, 2) -= 50.0;

  const FilteredSurface rest = filter_surface(
      field,
      {.side = FilterSide::kL, .nesting_um = 30.0, .method = FilterMethod::kGaussianRegression2, .robust = true});

  EXPECT_NEAR(rest.surface.z_um.at(30, 40), 100.0, 1e-8);
  EXPECT_NEAR(rest.surface.z_um.at(70, 2), -50.0, 1e-8);
  EXPECT_NEAR(rest.surface.z_um.at(31, 40), 0.0, 1e-8);
}

TEST(RobustRounds, EndAtOnceWhereEveryPointIsFitted) {
  const std::vector<double> z{1.0, 2.0, kHole};
  std::vector<double> weights{1.0, 1.0, 0.0};
  std::vector<double> smooth(3, kHole);
  int fits = 0;

  const RobustRounds rounds = fit_robustly(z, weights, smooth, [&] {
    ++fits;
    smooth = {1.0, 2.0, 5.0};
  });

  EXPECT_EQ(fits, 1);
  EXPECT_EQ(rounds.rounds, 1);
  EXPECT_TRUE(rounds.converged);
  EXPECT_FALSE(rounds.cut_um);
}

TEST(RobustRounds, SayWhenTheyDidNotConverge) {
  const std::vector<double> z{0.0, 0.0, 0.0};
  std::vector<double> weights(3, 1.0);
  std::vector<double> smooth(3, 0.0);
  int fits = 0;

  const RobustRounds rounds = fit_robustly(z, weights, smooth, [&] {
    ++fits;
    std::fill(smooth.begin(), smooth.end(), 1.0 + fits % 2);
  });

  EXPECT_EQ(fits, kMaxRobustRounds);
  EXPECT_EQ(rounds.rounds, kMaxRobustRounds);
  EXPECT_FALSE(rounds.converged);
}

TEST(RobustRounds, WeighByTukeysFormula) {
  const std::vector<double> z{0.1, -0.1, 0.1, 0.4, 3.0};
  std::vector<double> weights(5, 1.0);
  const std::vector<double> smooth(5, 0.0);

  const RobustRounds rounds = fit_robustly(z, weights, smooth, [] {});

  EXPECT_EQ(rounds.rounds, 2);  // the cut stays
  EXPECT_NEAR(*rounds.cut_um, 0.44478, 1e-12);
  EXPECT_NEAR(weights[0], std::pow(1.0 - std::pow(0.1 / 0.44478, 2), 2), 1e-12);
  EXPECT_NEAR(weights[3], std::pow(1.0 - std::pow(0.4 / 0.44478, 2), 2), 1e-12);
  EXPECT_EQ(weights[4], 0.0);
}

TEST(RobustRounds, LeaveTheWeightWhereAFitIsNotDetermined) {
  const std::vector<double> z{0.1, -0.1, 0.1, 0.4};
  std::vector<double> weights{1.0, 1.0, 1.0, 0.7};
  std::vector<double> smooth(4, 0.0);
  smooth[3] = kHole;

  (void)fit_robustly(z, weights, smooth, [] {});

  EXPECT_EQ(weights[3], 0.7);
  EXPECT_LT(weights[0], 1.0);
}

TEST(RobustRounds, TakeTheirScaleFromTheLargestResidualWhereMostAreNone) {
  const std::vector<double> z{0.0, 0.0, 0.0, 0.0001, 1.0};
  std::vector<double> weights(5, 1.0);
  const std::vector<double> smooth(5, 0.0);

  const RobustRounds rounds = fit_robustly(z, weights, smooth, [] {});

  EXPECT_NEAR(*rounds.cut_um, 0.001, 1e-15);
  EXPECT_EQ(weights[0], 1.0);
  EXPECT_GT(weights[3], 0.9);
  EXPECT_EQ(weights[4], 0.0);
}

}  // namespace
}  // namespace fvd::metrology
