#include "core/metrology/uncertainty/monte_carlo.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/metrology/uncertainty/linear_noise.hpp"
#include "tests/core/metrology/uncertainty/noisy_fields.hpp"

namespace fvd::metrology {
namespace {

using testing::box;
using testing::double_box;
using testing::uneven_field;

Region rectangle(const HeightField& field, int left, int top, int right, int bottom) {
  Region region(field.width(), field.height());
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) region.at(x, y) = 1;
  }
  return region;
}

std::optional<double> mean_of(const HeightField& field, const Region& region) {
  double sum = 0.0;
  int points = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (field.is_hole(x, y) || !is_inside(region, x, y)) continue;
      sum += field.z_um.at(x, y);
      ++points;
    }
  }
  if (points == 0) return std::nullopt;
  return sum / points;
}

WeightMap mean_weights(const HeightField& field, const Region& region) {
  WeightMap map{0, 0, Plane<double>(field.width(), field.height())};
  int points = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      map.weights.at(x, y) = field.is_hole(x, y) || !is_inside(region, x, y) ? 0.0 : 1.0;
      points += map.weights.at(x, y) > 0.0 ? 1 : 0;
    }
  }
  for (double& weight : map.weights.pixels()) weight /= points;
  return map;
}

std::vector<std::optional<double>> the_mean(const HeightField& field, const Region& region) {
  return {mean_of(field, region)};
}

TEST(MonteCarlo, OfAMeanIsTheLinearNoise) {
  for (const LateralKernel& kernel : {box(9), double_box(9, 5)}) {
    const HeightField field = uneven_field(60, 50, kernel, true);
    const Region region = rectangle(field, 3, 8, 40, 45);
    for (const int margin_px : {0, 4, -1}) {
      const std::optional<MonteCarlo> drawn = monte_carlo(field, region, {800, 5, margin_px}, the_mean);

      // The standard deviation of 800 draws is known to 2.5 %, their mean to 0.035 u.
      const double u = linear_noise(field, mean_weights(field, region))->u;
      ASSERT_TRUE(drawn && drawn->values.size() == 1 && drawn->values[0].u);
      EXPECT_NEAR(*drawn->values[0].u / u, 1.0, 0.08);
      EXPECT_NEAR((*drawn->values[0].mean - *mean_of(field, region)) / u, 0.0, 0.12);
      EXPECT_EQ(drawn->values[0].draws, 800);
      EXPECT_EQ(drawn->seed, 5U);
      EXPECT_EQ(drawn->draws, 800);
    }
  }
}

TEST(MonteCarlo, GivesTheSameFiguresForTheSameSeed) {
  const HeightField field = uneven_field(30, 30, box(5), true);
  const Region region = rectangle(field, 3, 3, 20, 25);

  const std::optional<MonteCarlo> first = monte_carlo(field, region, {20, 5, 2}, the_mean);
  const std::optional<MonteCarlo> second = monte_carlo(field, region, {20, 5, 2}, the_mean);
  const std::optional<MonteCarlo> other = monte_carlo(field, region, {20, 6, 2}, the_mean);

  ASSERT_TRUE(first && second && other);
  EXPECT_EQ(first->values[0].u, second->values[0].u);
  EXPECT_EQ(first->values[0].mean, second->values[0].mean);
  EXPECT_NE(first->values[0].u, other->values[0].u);
}

TEST(MonteCarlo, GivesTheSameFiguresWhateverThreadsThereAre) {
  const HeightField field = uneven_field(60, 50, double_box(9, 5), true);
  WorkerPool pool(3);
  const Region part = rectangle(field, 3, 8, 20, 25);
  const Region whole = rectangle(field, 0, 0, 60, 50);
  for (const Region* chosen : {&part, &whole}) {
    const Region& region = *chosen;
    const std::optional<MonteCarlo> alone = monte_carlo(field, region, {20, 5, 0}, the_mean);
    const std::optional<MonteCarlo> shared = monte_carlo(field, region, {20, 5, 0}, the_mean, &pool);

    ASSERT_TRUE(alone && shared);
    EXPECT_EQ(alone->values[0].u, shared->values[0].u);
    EXPECT_EQ(alone->values[0].mean, shared->values[0].mean);
  }
}

TEST(MonteCarlo, CutsTheFieldToTheRegionAndItsMargin) {
  HeightField field = uneven_field(40, 30, box(3), false);
  field.pitch_x_um = 0.5;
  field.pitch_y_um = 0.25;
  const Region region = rectangle(field, 10, 1, 20, 12);

  const std::optional<MonteCarlo> drawn =
      monte_carlo(field, region, {2, 1, 3}, [](const HeightField& part, const Region& inside) {
        // From column 7 to 23 and from row 0, the field's border, to 15.
        EXPECT_EQ(part.width(), 16);
        EXPECT_EQ(part.height(), 15);
        EXPECT_EQ(part.pitch_x_um, 0.5);
        EXPECT_EQ(part.pitch_y_um, 0.25);
        EXPECT_EQ(part.kernel.weights.size(), 3U);
        EXPECT_NEAR(part.z_um.at(0, 0), 0.7, 0.6);
        EXPECT_EQ(inside.at(2, 1), 0);
        EXPECT_EQ(inside.at(3, 1), 1);
        EXPECT_EQ(inside.at(12, 11), 1);
        EXPECT_EQ(inside.at(13, 11), 0);
        EXPECT_EQ(inside.at(5, 0), 0);
        return std::vector<std::optional<double>>{};
      });

  EXPECT_TRUE(drawn);
}

TEST(MonteCarlo, OfTheWholeFieldHasAnEmptyRegion) {
  const HeightField field = uneven_field(20, 10, box(3), false);

  const std::optional<MonteCarlo> drawn =
      monte_carlo(field, {}, {2, 1, 3}, [](const HeightField& part, const Region& inside) {
        EXPECT_EQ(part.width(), 20);
        EXPECT_EQ(part.height(), 10);
        EXPECT_TRUE(inside.empty());
        return std::vector<std::optional<double>>{};
      });

  EXPECT_TRUE(drawn);
}

TEST(MonteCarlo, GivesNoFigureWhereMoreThanOneInTenDrawsHasNone) {
  const HeightField field = uneven_field(20, 10, box(3), false);
  int call = 0;

  const std::optional<MonteCarlo> drawn = monte_carlo(field, {}, {20, 1, 0}, [&call](const auto&, const auto&) {
    const int draw = call++;
    std::vector<std::optional<double>> values(2);
    if (draw >= 2) values[0] = draw;
    if (draw >= 3) values[1] = draw;
    return values;
  });

  ASSERT_TRUE(drawn);
  ASSERT_EQ(drawn->values.size(), 2U);
  EXPECT_EQ(drawn->values[0].draws, 18);
  // 2 to 19: mean 10.5, variance (18^2 - 1) / 12 * 18 / 17.
  ASSERT_TRUE(drawn->values[0].u);
  EXPECT_NEAR(*drawn->values[0].mean, 10.5, 1e-12);
  EXPECT_NEAR(*drawn->values[0].u, std::sqrt(323.0 / 12.0 * 18.0 / 17.0), 1e-12);
  EXPECT_EQ(drawn->values[1].draws, 17);
  EXPECT_FALSE(drawn->values[1].u);
  EXPECT_FALSE(drawn->values[1].mean);
}

TEST(MonteCarlo, IsAbsentWithoutSigmaOrPoints) {
  HeightField field = uneven_field(20, 10, box(3), false);

  EXPECT_FALSE(monte_carlo(field, Region(20, 10), {2, 1, 0}, the_mean));
  field.sigma_um = {};
  EXPECT_FALSE(monte_carlo(field, {}, {2, 1, 0}, the_mean));
}

}  // namespace
}  // namespace fvd::metrology
