#include "core/metrology/uncertainty/linear_noise.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/uncertainty/noise_map.hpp"
#include "tests/core/metrology/uncertainty/noisy_fields.hpp"

namespace fvd::metrology {
namespace {

using testing::box;
using testing::correlation_along;
using testing::double_box;
using testing::uneven_field;

/// Weights of both signs; 0 in holes.
WeightMap uneven_weights(const HeightField& field, int left, int top, int width, int height, double tilt) {
  WeightMap map{left, top, Plane<double>(width, height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!field.is_hole(left + x, top + y)) map.weights.at(x, y) = 0.01 + tilt * (x - 0.4 * width) + 0.001 * (y % 4);
    }
  }
  return map;
}

WeightMap mean_weights(const HeightField& field, int left, int top, int width, int height) {
  WeightMap map{left, top, Plane<double>(width, height)};
  int points = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) points += field.is_hole(left + x, top + y) ? 0 : 1;
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) map.weights.at(x, y) = field.is_hole(left + x, top + y) ? 0.0 : 1.0 / points;
  }
  return map;
}

struct Weighted {
  int x;
  int y;
  double weight;
};

std::vector<Weighted> weighted(const HeightField& field, const WeightMap& map) {
  std::vector<Weighted> points;
  for (int y = 0; y < map.weights.height(); ++y) {
    for (int x = 0; x < map.weights.width(); ++x) {
      if (map.weights.at(x, y) == 0.0) continue;
      const double sigma = static_cast<double>(field.sigma_um.at(map.left + x, map.top + y));
      points.push_back({map.left + x, map.top + y, map.weights.at(x, y) * sigma});
    }
  }
  return points;
}

/// sum over i and j of w_i sigma_i rho(i - j) v_j sigma_j, point by point: GUM 5.2.2 as it is written.
double by_pairs(const HeightField& field, const WeightMap& first, const WeightMap& second) {
  double sum = 0.0;
  for (const Weighted& a : weighted(field, first)) {
    for (const Weighted& b : weighted(field, second)) {
      sum +=
          a.weight * b.weight * correlation_along(field.kernel, a.x - b.x) * correlation_along(field.kernel, a.y - b.y);
    }
  }
  return sum;
}

double sum_of(const WeightMap& map, const Plane<double>& z_um) {
  double sum = 0.0;
  for (int y = 0; y < map.weights.height(); ++y) {
    for (int x = 0; x < map.weights.width(); ++x) {
      if (map.weights.at(x, y) != 0.0) sum += map.weights.at(x, y) * z_um.at(map.left + x, map.top + y);
    }
  }
  return sum;
}

double sd_of_draws(const HeightField& field, const WeightMap& map, int draws) {
  NoiseMaps noise(field, 11);
  Plane<double> z_um(field.width(), field.height());
  const double truth = sum_of(map, field.z_um);
  double squares = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    noise.add_to_heights(static_cast<std::uint64_t>(draw), z_um);
    squares += std::pow(sum_of(map, z_um) - truth, 2);
  }
  return std::sqrt(squares / draws);
}

TEST(LinearNoise, IsTheDoubleSumOverAllPairs) {
  for (const LateralKernel& kernel : {LateralKernel{}, box(3), box(9), double_box(9, 5)}) {
    for (const bool with_holes : {false, true}) {
      const HeightField field = uneven_field(31, 24, kernel, with_holes);
      const WeightMap map = uneven_weights(field, 0, 3, 26, 21, 0.003);

      const std::optional<LinearNoise> noise = linear_noise(field, map);

      ASSERT_TRUE(noise);
      const double expected = std::sqrt(by_pairs(field, map, map));
      EXPECT_NEAR(noise->u / expected, 1.0, 1e-12) << kernel.weights.size() << with_holes;
    }
  }
}

TEST(LinearNoise, IsTheSameWhateverThreadsThereAreAndBandsItIsMadeIn) {
  WorkerPool pool(3);
  const HeightField field = uneven_field(13, 300, double_box(9, 5), true);  // the sum over pairs is of their number
  WeightMap map = uneven_weights(field, 2, 1, 10, 298, 0.003);
  for (int row = 100; row < 160; ++row) std::fill_n(map.weights.row(row), map.weights.width(), 0.0);

  const std::optional<LinearNoise> alone = linear_noise(field, map);
  const std::optional<LinearNoise> shared = linear_noise(field, map, &pool);

  ASSERT_TRUE(alone && shared);
  EXPECT_EQ(alone->u, shared->u);
  EXPECT_EQ(alone->points_as_one, shared->points_as_one);
  EXPECT_NEAR(alone->u * alone->u / by_pairs(field, map, map), 1.0, 1e-12);
}

TEST(LinearNoise, OfABoxIsPointsTimesTheSquaredBoxMeans) {
  const HeightField field = uneven_field(31, 24, box(9), true);
  const WeightMap map = uneven_weights(field, 4, 2, 20, 19, -0.002);

  const std::optional<LinearNoise> noise = linear_noise(field, map);

  double sum = 0.0;
  for (int py = -20; py < 50; ++py) {
    for (int px = -20; px < 60; ++px) {
      double box_sum = 0.0;
      for (const Weighted& point : weighted(field, map)) {
        if (std::abs(point.x - px) <= 4 && std::abs(point.y - py) <= 4) box_sum += point.weight;
      }
      sum += 81.0 * (box_sum / 81.0) * (box_sum / 81.0);
    }
  }
  ASSERT_TRUE(noise);
  EXPECT_NEAR(noise->u / std::sqrt(sum), 1.0, 1e-12);
}

TEST(LinearNoise, OfAMeanCountsWindowsAndNotPoints) {
  HeightField field = uneven_field(64, 64, box(9), false);
  set_uniform_sigma(field, 0.25);
  const WeightMap map = mean_weights(field, 10, 12, 40, 40);

  const std::optional<LinearNoise> noise = linear_noise(field, map);

  // Along one axis the sum of the squared box means of 40 ones is 40 - 8 + 2 (1 + 4 + .. + 64) / 81 = 32 + 408 / 81.
  const double along = 9.0 * (32.0 + 408.0 / 81.0) / 40.0;
  ASSERT_TRUE(noise);
  EXPECT_NEAR(noise->points_as_one, along * along, 1e-9);
  EXPECT_NEAR(noise->u, 0.25 * along / 40.0, 1e-9);
}

TEST(LinearNoise, WithoutAWindowIsThatOfIndependentPoints) {
  HeightField field = uneven_field(20, 10, LateralKernel{}, false);
  set_uniform_sigma(field, 0.5);
  const WeightMap map = mean_weights(field, 0, 0, 20, 10);

  const std::optional<LinearNoise> noise = linear_noise(field, map);

  ASSERT_TRUE(noise);
  EXPECT_NEAR(noise->u, 0.5 / std::sqrt(200.0), 1e-15);
  EXPECT_NEAR(noise->points_as_one, 1.0, 1e-12);
}

TEST(LinearNoise, IsWhatDrawsOfTheNoiseShow) {
  for (const LateralKernel& kernel : {box(9), double_box(9, 5)}) {
    const HeightField field = uneven_field(48, 40, kernel, true);
    for (const WeightMap& map : {uneven_weights(field, 0, 0, 30, 40, 0.002), mean_weights(field, 8, 5, 40, 30)}) {
      const std::optional<LinearNoise> noise = linear_noise(field, map);

      // The standard deviation of 400 draws is known to 3.5 %.
      ASSERT_TRUE(noise);
      EXPECT_NEAR(sd_of_draws(field, map, 400) / noise->u, 1.0, 0.1);
    }
  }
}

TEST(LinearNoise, IsAbsentWithoutSigma) {
  HeightField field = uneven_field(12, 12, box(3), false);
  const WeightMap map = mean_weights(field, 0, 0, 12, 12);
  field.sigma_um = {};
  const std::array<const WeightMap*, 1> maps{&map};

  EXPECT_FALSE(linear_noise(field, map));
  EXPECT_FALSE(linear_covariance(field, maps));
}

TEST(LinearNoise, OfNoWeightsIsNothing) {
  const HeightField field = uneven_field(12, 12, box(3), true);
  const WeightMap map{2, 2, Plane<double>(5, 5)};

  const std::optional<LinearNoise> noise = linear_noise(field, map);

  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->u, 0.0);
  EXPECT_EQ(noise->points_as_one, 1.0);
}

TEST(LinearCovariance, IsTheDoubleSumOverAllPairsOfTwoEstimates) {
  for (const LateralKernel& kernel : {box(9), double_box(5, 3)}) {
    const HeightField field = uneven_field(44, 40, kernel, true);
    // The second overlaps the first, the third is a neighbour of it, the fourth is out of the window's reach.
    const std::array maps{uneven_weights(field, 6, 9, 14, 10, 0.004), uneven_weights(field, 12, 4, 9, 9, -0.006),
                          uneven_weights(field, 0, 21, 30, 6, 0.002), uneven_weights(field, 33, 34, 11, 6, 0.001)};
    const std::array<const WeightMap*, 4> pointers{&maps[0], &maps[1], &maps[2], &maps[3]};

    const std::optional<std::vector<double>> covariance = linear_covariance(field, pointers);

    ASSERT_TRUE(covariance);
    ASSERT_EQ(covariance->size(), 16U);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const double expected = by_pairs(field, maps[i], maps[j]);
        const double scale = std::sqrt(by_pairs(field, maps[i], maps[i]) * by_pairs(field, maps[j], maps[j]));
        EXPECT_NEAR((*covariance)[4 * i + j] / scale, expected / scale, 1e-12) << i << j;
      }
    }
    EXPECT_EQ((*covariance)[3], 0.0);
    EXPECT_GT(std::abs((*covariance)[2]), 0.0);
  }
}

TEST(LinearCovariance, HasTheVariancesOnItsDiagonal) {
  const HeightField field = uneven_field(30, 30, box(9), true);
  const std::array maps{uneven_weights(field, 1, 2, 14, 10, 0.004), mean_weights(field, 12, 14, 18, 16)};
  const std::array<const WeightMap*, 2> pointers{&maps[0], &maps[1]};

  const std::optional<std::vector<double>> covariance = linear_covariance(field, pointers);

  ASSERT_TRUE(covariance);
  EXPECT_NEAR(std::sqrt((*covariance)[0]) / linear_noise(field, maps[0])->u, 1.0, 1e-12);
  EXPECT_NEAR(std::sqrt((*covariance)[3]) / linear_noise(field, maps[1])->u, 1.0, 1e-12);
}

TEST(UniformSigma, IsGivenToPointsAndNotToHoles) {
  HeightField field = uneven_field(12, 12, box(3), true);
  field.sigma_um = {};

  set_uniform_sigma(field, 0.125);

  ASSERT_TRUE(field.has_sigma());
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 12; ++x) {
      if (field.is_hole(x, y)) {
        EXPECT_TRUE(std::isnan(field.sigma_um.at(x, y)));
      } else {
        EXPECT_EQ(field.sigma_um.at(x, y), 0.125F);
      }
    }
  }
}

}  // namespace
}  // namespace fvd::metrology
