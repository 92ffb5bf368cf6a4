#include "core/metrology/filter/profile_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/filter/gaussian_kernel.hpp"
#include "tests/core/metrology/filter/local_fit_reference.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

/// A rough parabola with a long hole and single ones.
std::vector<double> rough_profile(int points) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<double> z;
  for (int i = 0; i < points; ++i) z.push_back(noise(random) + 0.01 * i * i);
  for (int i = 20; i < 29; ++i) z[static_cast<std::size_t>(i)] = kHole;
  z[3] = kHole;
  z[60] = kHole;
  return z;
}

TEST(ProfileFilter, IsTheLocalFitOfItsDefinitionBesideHolesAndBorders) {
  double worst = 0.0;
  const std::vector<double> z = rough_profile(90);
  auto row = Plane<double>::unset(90, 3);  // three equal rows determine the terms in y, which are 0
  for (int y = 0; y < 3; ++y) std::copy(z.begin(), z.end(), row.row(y));
  const FilterMethod methods[] = {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1,
                                  FilterMethod::kGaussianRegression2};
  for (int order = 0; order < 3; ++order) {
    const FilteredProfile smooth =
        filter_profile(z, 0.5, {.side = FilterSide::kS, .nesting_um = 9.0, .method = methods[order]});
    const double deviation = reference_deviation(order, 18.0);
    for (int i = 0; i < 90; ++i) {
      const double value = smooth.z_um[static_cast<std::size_t>(i)];
      if (std::isnan(z[static_cast<std::size_t>(i)])) {
        EXPECT_TRUE(std::isnan(value));
        continue;
      }
      if (order == 0 && std::isnan(value)) continue;
      const double error = std::abs(value - local_fit(row, {}, i, 1, order, deviation, deviation));
      EXPECT_LT(error, 2e-4) << order << " " << i;  // the reference's kernel never ends
      worst = std::max(worst, error);
    }
  }
  RecordProperty("filter_worst_profiles_with_holes", std::to_string(worst));
}

/// The local fit of the kernel as it is sampled, by normal equations in long double.
long double fit_at(const std::vector<double>& z, int at, FilterMethod method, double nesting_px) {
  const SampledGaussian kernel = sample_gaussian(method, nesting_px);
  const int reach = static_cast<int>(kernel.weights.size()) - 1;
  const int terms = method == FilterMethod::kGaussian ? 1 : (method == FilterMethod::kGaussianRegression1 ? 2 : 3);
  long double a[3][4] = {};
  for (int i = std::max(0, at - reach); i <= std::min(static_cast<int>(z.size()) - 1, at + reach); ++i) {
    if (std::isnan(z[static_cast<std::size_t>(i)])) continue;
    const long double weight = kernel.weights[static_cast<std::size_t>(std::abs(i - at))];
    const long double x = static_cast<long double>(i - at) / kernel.deviation_px;
    for (int row = 0; row < terms; ++row) {
      for (int column = 0; column < terms; ++column) a[row][column] += weight * std::pow(x, row + column);
      a[row][3] += weight * std::pow(x, row) * z[static_cast<std::size_t>(i)];
    }
  }
  for (int k = terms - 1; k > 0; --k) {
    for (int row = 0; row < k; ++row) {
      const long double factor = a[row][k] / a[k][k];
      for (int column = 0; column < k; ++column) a[row][column] -= factor * a[k][column];
      a[row][3] -= factor * a[k][3];
    }
  }
  return a[0][3] / a[0][0];
}

TEST(ProfileFilter, GivesTheSameFitFarFromHolesAndBesideThem) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<double> z;
  for (int i = 0; i < 330; ++i) z.push_back(noise(random) + 0.002 * i * i);
  z[150] = kHole;  // between two runs longer than the kernel
  for (const FilterMethod method :
       {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1, FilterMethod::kGaussianRegression2}) {
    const FilteredProfile smooth =
        filter_profile(z, 0.5, {.side = FilterSide::kS, .nesting_um = 8.0, .method = method});
    int compared = 0;
    for (int i = 0; i < 330; ++i) {
      const double value = smooth.z_um[static_cast<std::size_t>(i)];
      if (std::isnan(value)) continue;
      EXPECT_NEAR(value, static_cast<double>(fit_at(z, i, method, 16.0)), 1e-11) << i;
      ++compared;
    }
    EXPECT_GE(compared, 300);
  }
}

TEST(ProfileFilter, KeepsParabolasUpToBordersAndHoles) {
  std::vector<double> z;
  for (int i = 0; i < 120; ++i) z.push_back(40.0 - 0.3 * i + 0.02 * i * i);
  for (int i = 40; i < 70; ++i) z[static_cast<std::size_t>(i)] = kHole;

  const FilteredProfile rest = filter_profile(
      z, 1.0, {.side = FilterSide::kL, .nesting_um = 30.0, .method = FilterMethod::kGaussianRegression2});

  for (std::size_t i = 0; i < z.size(); ++i) {
    ASSERT_EQ(std::isnan(rest.z_um[i]), std::isnan(z[i]));
    if (!std::isnan(z[i])) {
      EXPECT_NEAR(rest.z_um[i], 0.0, 1e-9);
    }
  }
  EXPECT_EQ(rest.report.points_in, 90u);
  EXPECT_EQ(rest.report.points_lost, 0u);
  EXPECT_EQ(rest.report.border_error_um, 0.0);
}

/// At the border itself, half a pitch before the first point: the parabola through the first three values.
double at_border(const std::vector<double>& z) { return (15.0 * z[0] - 10.0 * z[1] + 3.0 * z[2]) / 8.0; }

TEST(ProfileFilter, LeavesTheKnownErrorOfASlopeAtABorder) {
  constexpr double kPitch = 0.25;
  std::vector<double> z;
  for (int i = 0; i < 2000; ++i) z.push_back(0.1 * (i + 0.5) * kPitch);

  const FilteredProfile mean = filter_profile(z, kPitch, {.side = FilterSide::kS, .nesting_um = 80.0});
  const FilteredProfile line = filter_profile(
      z, kPitch, {.side = FilterSide::kS, .nesting_um = 80.0, .method = FilterMethod::kGaussianRegression1});

  EXPECT_NEAR(at_border(mean.z_um), 1.19613, 2e-5);
  EXPECT_NEAR(at_border(line.z_um), 0.0, 1e-10);
  EXPECT_NEAR(mean.report.border_error_um, 1.19613, 0.01);  // for the first point, not for the border
  EXPECT_LT(mean.report.border_error_um, 1.19613);
}

TEST(ProfileFilter, RefusesNestingIndicesBelowFivePointsWithTheFigure) {
  const std::vector<double> z(50, 1.0);

  EXPECT_NO_THROW((void)filter_profile(z, 0.07, {.nesting_um = 0.35}));
  try {
    (void)filter_profile(z, 2.0, {.nesting_um = 9.8});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("4.9 pixels"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)filter_profile(z, 1.0, {.nesting_um = kHole}), Error);
  EXPECT_THROW((void)filter_profile(z, 1.0, {.nesting_um = -10.0}), Error);
  EXPECT_THROW((void)filter_profile({}, 1.0, {.nesting_um = 10.0}), Error);
}

TEST(ProfileFilter, TakesAMarginAwayFromTheRestByTheMeanAlone) {
  const std::vector<double> z(100, 1.0);
  FilterSettings settings{.side = FilterSide::kL, .nesting_um = 20.0};

  const FilteredProfile rest = filter_profile(z, 1.0, settings);
  settings.keep_margin = true;
  const FilteredProfile whole = filter_profile(z, 1.0, settings);

  EXPECT_TRUE(std::isnan(rest.z_um[9]));
  EXPECT_FALSE(std::isnan(rest.z_um[10]));
  EXPECT_FALSE(std::isnan(rest.z_um[89]));
  EXPECT_TRUE(std::isnan(rest.z_um[90]));
  EXPECT_EQ(rest.report.margin_um, 10.0);
  EXPECT_EQ(rest.report.points_lost, 20u);
  EXPECT_EQ(whole.report.points_lost, 0u);
  settings = {.side = FilterSide::kS, .nesting_um = 20.0};
  EXPECT_EQ(filter_profile(z, 1.0, settings).report.points_lost, 0u);
}

}  // namespace
}  // namespace fvd::metrology
