#include "core/metrology/areal/height_moments.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

/// Rough, far from zero, with one outlier that is `outlier` times the roughness.
std::vector<double> heights(std::size_t count, double outlier) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(1234.5, 0.3);
  std::vector<double> z(count);
  for (double& value : z) value = normal(random);
  z[count / 3] += 0.3 * outlier;
  return z;
}

struct Exact {
  long double mean = 0.0L;
  long double absolute = 0.0L;
  long double squares = 0.0L;
  long double cubes = 0.0L;
  long double fourths = 0.0L;
};

Exact exact(const std::vector<double>& z) {
  Exact sums;
  const auto count = static_cast<long double>(z.size());
  for (const double value : z) sums.mean += value / count;
  for (const double value : z) {
    const long double h = value - sums.mean;
    sums.absolute += std::abs(h) / count;
    sums.squares += h * h / count;
    sums.cubes += h * h * h / count;
    sums.fourths += h * h * h * h / count;
  }
  return sums;
}

std::vector<double> about(double mean_um, std::vector<double> z) {
  for (double& value : z) value -= mean_um;
  return z;
}

void expect_relative(double value, long double wanted, double tolerance) {
  EXPECT_NEAR(value, static_cast<double>(wanted), tolerance * static_cast<double>(std::abs(wanted)));
}

TEST(HeightMoments, AreThoseOfLongDouble) {
  for (const std::size_t count : {3U, 100U, 1023U, 1024U, 1025U, 300000U}) {
    for (const double outlier : {0.0, 1e4}) {
      const std::vector<double> z = heights(count, outlier);
      const Exact wanted = exact(z);
      const double mean_um = mean_height_um(z);

      const HeightMoments found = height_moments(about(mean_um, z));

      const double digits = 1e-15 * 1234.5;  // of a height less the mean
      EXPECT_NEAR(mean_um, static_cast<double>(wanted.mean), digits);
      EXPECT_NEAR(found.mean_absolute_um, static_cast<double>(wanted.absolute), digits);
      expect_relative(found.root_mean_square_um, std::sqrt(wanted.squares), 1e-12);
      if (count > 3) {
        EXPECT_NEAR(found.skewness, static_cast<double>(wanted.cubes / std::pow(wanted.squares, 1.5L)),
                    1e-11 * std::max(1.0, std::abs(found.skewness)));
      }
      expect_relative(found.kurtosis, wanted.fourths / (wanted.squares * wanted.squares), 1e-11);
      EXPECT_EQ(found.peak_um, *std::max_element(z.begin(), z.end()) - mean_um);
      EXPECT_EQ(found.pit_um, mean_um - *std::min_element(z.begin(), z.end()));
    }
  }
}

TEST(HeightMoments, AreTheSameBytesInAnyOrder) {
  std::mt19937_64 random(9);
  std::vector<double> z = heights(5000, 40.0);
  const double mean_um = mean_height_um(z);
  const HeightMoments expected = height_moments(about(mean_um, z));
  for (int round = 0; round < 20; ++round) {
    std::shuffle(z.begin(), z.end(), random);

    const HeightMoments found = height_moments(about(mean_height_um(z), z));

    ASSERT_EQ(mean_height_um(z), mean_um);
    ASSERT_EQ(found.mean_absolute_um, expected.mean_absolute_um);
    ASSERT_EQ(found.root_mean_square_um, expected.root_mean_square_um);
    ASSERT_EQ(found.skewness, expected.skewness);
    ASSERT_EQ(found.kurtosis, expected.kurtosis);
    ASSERT_EQ(found.total_um(), expected.total_um());
  }
}

TEST(HeightMoments, OfEqualHeightsAreNothing) {
  const std::vector<double> z(2000, 12.75);
  ASSERT_EQ(mean_height_um(z), 12.75);

  const HeightMoments found = height_moments(about(12.75, z));

  EXPECT_EQ(found.mean_absolute_um, 0.0);
  EXPECT_EQ(found.root_mean_square_um, 0.0);
  EXPECT_EQ(found.kurtosis, 0.0);
  EXPECT_EQ(found.total_um(), 0.0);
}

}  // namespace
}  // namespace fvd::metrology
