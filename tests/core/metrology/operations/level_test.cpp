#include "core/metrology/operations/level.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/operations/region.hpp"
#include "tests/core/metrology/operations/operation_fields.hpp"

namespace fvd::metrology {
namespace {

constexpr double kOffset = -3.0;
constexpr double kSlopeX = 0.02;
constexpr double kSlopeY = -0.05;

double plane(double x, double y) { return kOffset + kSlopeX * x + kSlopeY * y; }

class EveryLevel : public testing::TestWithParam<LevelMethod> {};

TEST_P(EveryLevel, RemovesAPlaneAndNamesIt) {
  HeightField field = make_field(83, 61, 0.5, 0.8, plane);
  field.sigma_um = Plane<float>(83, 61, 0.2F);
  punch_holes(field, 0.1, 1);
  const std::size_t holes = hole_count(field);

  const OperationReport report = level(field, GetParam(), {});

  EXPECT_FALSE(report.refused);
  EXPECT_NEAR(value(report, "offset_um"), kOffset, 1e-12);
  EXPECT_NEAR(value(report, "slope_x"), kSlopeX, 1e-13);
  EXPECT_NEAR(value(report, "slope_y"), kSlopeY, 1e-13);
  EXPECT_LT(largest(field), 1e-12);
  EXPECT_EQ(hole_count(field), holes);
  EXPECT_EQ(report.points_used, 83U * 61U - holes);
}

TEST_P(EveryLevel, LooksOnlyAtItsRegionAndLevelsEverything) {
  HeightField field =
      make_field(60, 40, 1.0, 1.0, [](double x, double y) { return plane(x, y) + (x > 30.0 ? y * y : 0.0); });
  field.sigma_um = Plane<float>(60, 40, 0.2F);
  const Region region = rectangle_region(grid_of(field), {5.0, 5.0, 20.0, 30.0});

  const OperationReport report = level(field, GetParam(), region);

  EXPECT_NEAR(field.z_um.at(2, 2), 0.0, 1e-12);
  EXPECT_NEAR(field.z_um.at(40, 20), 20.5 * 20.5, 1e-11);
  EXPECT_EQ(report.points_used, 600U);
}

TEST_P(EveryLevel, GivesTheSameOnATransposedAndAMirroredSurface) {
  HeightField field =
      make_field(131, 77, 0.5, 0.8, [](double x, double y) { return plane(x, y) + (x > 45.0 ? 5.0 : 0.0); });
  add_noise(field, 0.3, 7);
  field.sigma_um = Plane<float>(131, 77);
  for (int i = 0; i < 131; ++i) {
    for (int j = 0; j < 77; ++j) field.sigma_um.at(i, j) = 0.1F + 0.01F * static_cast<float>((i * j) % 17);
  }
  punch_holes(field, 0.1, 8);
  HeightField turned = transposed(field);
  HeightField flipped = mirrored(field);

  (void)level(field, GetParam(), {});
  (void)level(turned, GetParam(), {});
  (void)level(flipped, GetParam(), {});

  const double scale = largest(field);
  EXPECT_LT(worst_difference(transposed(turned.z_um), field.z_um), 1e-12 * scale);
  EXPECT_LT(worst_difference(mirrored(flipped.z_um), field.z_um), 1e-12 * scale);
}

TEST_P(EveryLevel, IsRefusedOnALineOfPoints) {
  HeightField field = make_field(20, 10, 1.0, 1.0, plane);
  field.sigma_um = Plane<float>(20, 10, 0.2F);
  const HeightField before = field.clone();

  EXPECT_TRUE(level(field, GetParam(), rectangle_region(grid_of(field), {0.0, 3.0, 20.0, 1.0})).refused);
  EXPECT_TRUE(level(field, GetParam(), Region(20, 10)).refused);
  EXPECT_EQ(worst_difference(field.z_um, before.z_um), 0.0);
}

TEST_P(EveryLevel, IsTheSameOnAnyNumberOfThreads) {
  HeightField one = make_field(50, 200, 1.0, 1.0, plane);
  add_noise(one, 0.3, 9);
  one.sigma_um = Plane<float>(50, 200, 0.2F);
  HeightField three = one.clone();
  WorkerPool pool(3);

  (void)level(one, GetParam(), {});
  (void)level(three, GetParam(), {}, &pool);

  EXPECT_EQ(worst_difference(one.z_um, three.z_um), 0.0);
}

TEST_P(EveryLevel, PredictsTheScatterOfItsSlopes) {
  constexpr int kRuns = 200;
  double squares = 0.0;
  double predicted = 0.0;
  for (unsigned run = 0; run < kRuns; ++run) {
    HeightField field = make_field(30, 20, 1.0, 1.0, plane);
    field.sigma_um = Plane<float>(30, 20, 0.3F);
    add_noise(field, 0.3, 100 + run);
    const OperationReport report = level(field, GetParam(), {});
    squares += std::pow(value(report, "slope_x") - kSlopeX, 2);
    predicted += std::pow(error_of(report, "slope_x"), 2);
  }

  EXPECT_NEAR(std::sqrt(squares / predicted), 1.0, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryLevel,
                         testing::Values(LevelMethod::kLeastSquares, LevelMethod::kWeighted, LevelMethod::kRobust));

TEST(Level, EnlargesStandardErrorsByTheWidthOfTheWindow) {
  HeightField field = make_field(40, 40, 1.0, 1.0, plane);
  add_noise(field, 0.3, 10);
  HeightField shared = field.clone();
  shared.kernel.weights = std::vector<double>(9, 1.0 / 9.0);

  const OperationReport alone = level(field, LevelMethod::kLeastSquares, {});
  const OperationReport averaged = level(shared, LevelMethod::kLeastSquares, {});

  for (const char* name : {"offset_um", "slope_x", "slope_y"}) {
    EXPECT_NEAR(error_of(averaged, name), 9.0 * error_of(alone, name), 1e-12);
  }
}

TEST(Level, WeighsByTheInverseVariance) {
  HeightField field = make_field(40, 2, 1.0, 1.0, [](double, double) { return 0.0; });
  field.sigma_um = Plane<float>(40, 2, 1.0F);
  for (int column = 0; column < 40; ++column) {
    for (int row = 0; row < 2; ++row) {
      if (column % 2 == 1) field.z_um.at(column, row) = 10.0;
      if (column % 2 == 1) field.sigma_um.at(column, row) = 3.0F;
    }
  }

  const OperationReport report = level(field, LevelMethod::kWeighted, {});

  // Weights 9 : 1 at alternating columns; closed form of the line through both combs.
  long double w = 0, wx = 0, wxx = 0, wz = 0, wxz = 0;
  for (int column = 0; column < 40; ++column) {
    const long double weight = column % 2 == 1 ? 1.0L / 9.0L : 1.0L;
    const long double x = column + 0.5L;
    const long double z = column % 2 == 1 ? 10.0L : 0.0L;
    w += weight, wx += weight * x, wxx += weight * x * x, wz += weight * z, wxz += weight * x * z;
  }
  const long double slope = (w * wxz - wx * wz) / (w * wxx - wx * wx);
  EXPECT_NEAR(value(report, "slope_x"), static_cast<double>(slope), 1e-13);
  EXPECT_NEAR(value(report, "offset_um"), static_cast<double>((wz - slope * wx) / w), 1e-12);
}

TEST(Level, NeedsStandardErrorsForWeights) {
  HeightField field = make_field(4, 4, 1.0, 1.0, plane);
  EXPECT_TRUE(level(field, LevelMethod::kWeighted, {}).refused);

  field.sigma_um = Plane<float>(4, 4, 0.1F);
  field.sigma_um.at(1, 1) = 0.0F;
  const OperationReport report = level(field, LevelMethod::kWeighted, {});

  EXPECT_EQ(report.points_used, 15U);
  EXPECT_EQ(report.warnings.size(), 1U);
}

TEST(RobustLevel, FollowsTheMajorityPastAStep) {
  HeightField field =
      make_field(200, 150, 1.0, 1.0, [](double x, double y) { return plane(x, y) + (x > 122.0 ? 50.0 : 0.0); });
  add_noise(field, 0.2, 11);

  const OperationReport report = level(field, LevelMethod::kRobust, {});

  EXPECT_NEAR(value(report, "offset_um"), kOffset, 0.02);
  EXPECT_NEAR(value(report, "slope_x"), kSlopeX, 1e-4);
  EXPECT_NEAR(value(report, "slope_y"), kSlopeY, 1e-4);
  EXPECT_NEAR(value(report, "share_without_weight"), 0.39, 0.02);
  EXPECT_TRUE(report.warnings.empty());
}

TEST(RobustLevel, SolvesTheEquationsOfTukeysWeights) {
  HeightField field = make_field(60, 50, 1.0, 1.0, plane);
  add_noise(field, 0.2, 12);
  for (int i = 0; i < 300; ++i) field.z_um.pixels()[static_cast<std::size_t>(i * 7)] += 0.02 * i;

  const OperationReport report = level(field, LevelMethod::kRobust, {});

  std::vector<double> sizes;
  for (const double z : field.z_um.pixels()) sizes.push_back(std::abs(z));
  std::sort(sizes.begin(), sizes.end());
  const double cut = 4.4478 * 0.5 * (sizes[1499] + sizes[1500]);
  long double sum = 0, sum_x = 0, sum_y = 0;
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 60; ++column) {
      const long double r = static_cast<long double>(field.z_um.at(column, row));
      const long double t = 1.0L - r * r / (static_cast<long double>(cut) * static_cast<long double>(cut));
      const long double pull = t > 0.0L ? t * t * r : 0.0L;
      sum += pull, sum_x += pull * (column - 29.5L), sum_y += pull * (row - 24.5L);
    }
  }
  EXPECT_NEAR(value(report, "cut_um"), cut, 1e-9);
  EXPECT_NEAR(static_cast<double>(sum), 0.0, 1e-9);
  EXPECT_NEAR(static_cast<double>(sum_x), 0.0, 1e-8);
  EXPECT_NEAR(static_cast<double>(sum_y), 0.0, 1e-8);
}

}  // namespace
}  // namespace fvd::metrology
