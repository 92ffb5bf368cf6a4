#include "core/metrology/filter/band_moments.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

Plane<double> random_plane(int width, int height) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> level(-1.0, 1.0);
  Plane<double> plane(width, height);
  for (double& value : plane.pixels()) value = level(random);
  return plane;
}

std::vector<double> falling(int reach) {
  std::vector<double> half;
  for (int d = 0; d <= reach; ++d) half.push_back(1.0 / (1.0 + d));
  return half;
}

double sum_at(const Plane<double>& source, const SeparableKernel& kernel, int x, int y, MomentPower power) {
  const auto reach_x = static_cast<int>(kernel.half_x.size()) - 1;
  const auto reach_y = static_cast<int>(kernel.half_y.size()) - 1;
  double sum = 0.0;
  for (int dy = -reach_y; dy <= reach_y; ++dy) {
    for (int dx = -reach_x; dx <= reach_x; ++dx) {
      if (x - dx < 0 || x - dx >= source.width() || y - dy < 0 || y - dy >= source.height()) continue;
      sum += source.at(x - dx, y - dy) * std::pow(dx / kernel.unit_x_px, power.x) *
             std::pow(dy / kernel.unit_y_px, power.y) * kernel.half_x[static_cast<std::size_t>(std::abs(dx))] *
             kernel.half_y[static_cast<std::size_t>(std::abs(dy))];
    }
  }
  return sum;
}

TEST(BandMoments, AreTheSumsOfTheirDefinition) {
  const Plane<double> source = random_plane(23, 17);
  const SeparableKernel kernel{falling(5), falling(30), 2.0, 4.0};
  constexpr std::array<MomentPower, 5> kPowers{{{0, 0}, {1, 0}, {0, 3}, {1, 1}, {4, 2}}};
  BandMoments moments(23, 17, kernel, 4, nullptr);
  std::array<Plane<double>, 5> sums;

  moments.compute(source, 0, kPowers, sums);

  ASSERT_EQ(moments.bands(), 1);
  for (std::size_t k = 0; k < kPowers.size(); ++k) {
    for (int y = 0; y < 17; ++y) {
      for (int x = 0; x < 23; ++x) {
        const double expected = sum_at(source, kernel, x, y, kPowers[k]);
        EXPECT_NEAR(sums[k].at(x, y), expected, 1e-10) << k << " " << x << " " << y;
      }
    }
  }
}

TEST(BandMoments, AreTheSameWhereTwoBandsMeet) {
  const Plane<double> source = random_plane(1000, 2500);
  const SeparableKernel kernel{falling(8), falling(9), 1.0, 1.0};
  constexpr std::array<MomentPower, 1> kPowers{{{0, 1}}};
  BandMoments moments(1000, 2500, kernel, 1, nullptr);

  ASSERT_EQ(moments.bands(), 3);
  EXPECT_EQ(moments.first_row(3), 2500);
  for (int band = 0; band < 3; ++band) {
    std::array<Plane<double>, 1> sums;
    moments.compute(source, band, kPowers, sums);
    const int first = moments.first_row(band);
    for (const int row : {0, 3, sums[0].height() - 1}) {
      for (const int x : {0, 500, 999}) {
        EXPECT_NEAR(sums[0].at(x, row), sum_at(source, kernel, x, first + row, kPowers[0]), 1e-10);
      }
    }
  }
}

TEST(SeparableSum, IsTheSameForShortKernelsAndLongOnes) {
  const Plane<double> source = random_plane(60, 40);
  const SeparableKernel short_kernel{falling(7), falling(4), 1.0, 1.0};
  SeparableKernel long_kernel = short_kernel;
  long_kernel.half_x.resize(100, 0.0);

  const Plane<double> added = separable_sum(source, short_kernel, nullptr);
  const Plane<double> transformed = separable_sum(source, long_kernel, nullptr);

  for (std::size_t i = 0; i < added.pixels().size(); ++i) {
    EXPECT_NEAR(added.pixels()[i], transformed.pixels()[i], 1e-12);
  }
  EXPECT_NEAR(added.at(59, 2), sum_at(source, short_kernel, 59, 2, {0, 0}), 1e-12);
}

}  // namespace
}  // namespace fvd::metrology
