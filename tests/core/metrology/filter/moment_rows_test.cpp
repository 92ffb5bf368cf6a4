#include "core/metrology/filter/moment_rows.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/metrology/filter/separable_sum.hpp"

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

TEST(MomentRows, AreTheSumsOfTheirDefinition) {
  const Plane<double> source = random_plane(23, 17);
  const SeparableKernel kernel{falling(5), falling(30), 2.0, 4.0};
  MomentRows moments(23, 17, kernel, 4, 4, nullptr);

  const MomentRows::Band band = moments.load(source, 0, 3);

  ASSERT_EQ(moments.bands(), 1);
  for (const MomentPower power : {MomentPower{0, 0}, {1, 0}, {0, 3}, {1, 1}, {4, 2}}) {
    for (int y = 0; y < 17; ++y) {
      std::array<double, 23> sums{};
      moments.sum_row(band, y, power, 0, sums.data());
      for (int x = 0; x < 23; ++x) {
        EXPECT_NEAR(sums[static_cast<std::size_t>(x)], sum_at(source, kernel, x, y, power), 1e-10);
      }
    }
  }
}

TEST(MomentRows, AreTheSameWhereBandsMeet) {
  const Plane<double> source = random_plane(1000, 900);
  const SeparableKernel kernel{falling(8), falling(70), 1.0, 1.0};
  for (const int bands : {2, 3}) {  // without and with one that has neighbours on both sides
    MomentRows moments(1000, 900, kernel, 1, bands == 2 ? 20 : 40, nullptr);
    ASSERT_EQ(moments.bands(), bands);
    EXPECT_EQ(moments.first_row(bands), 900);
    for (int k = 0; k < bands; ++k) {
      const MomentRows::Band band = moments.load(source, k, 1);
      for (const int row : {moments.first_row(k), moments.first_row(k) + 3, moments.first_row(k + 1) - 1}) {
        std::vector<double> sums(1000);
        moments.sum_row(band, row, {0, 1}, 0, sums.data());
        for (const std::size_t x : {0u, 500u, 999u}) {
          EXPECT_NEAR(sums[x], sum_at(source, kernel, static_cast<int>(x), row, {0, 1}), 1e-10);
        }
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
