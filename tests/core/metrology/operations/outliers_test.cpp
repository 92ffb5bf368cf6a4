#include "core/metrology/operations/outliers.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/core/metrology/operations/operation_fields.hpp"

namespace fvd::metrology {
namespace {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// The rule as it is written, point by point.
bool is_outlier(const HeightField& field, int column, int row, const OutlierSettings& settings) {
  const int reach = settings.window_px / 2;
  std::vector<double> valid;
  int points = 0;
  for (int y = std::max(row - reach, 0); y <= std::min(row + reach, field.height() - 1); ++y) {
    for (int x = std::max(column - reach, 0); x <= std::min(column + reach, field.width() - 1); ++x) {
      ++points;
      if (!field.is_hole(x, y)) valid.push_back(field.z_um.at(x, y));
    }
  }
  if (field.is_hole(column, row) || 2 * static_cast<int>(valid.size()) < points) return false;
  const double median = median_of(valid);
  for (double& z : valid) z = std::abs(z - median);
  const double mad = median_of(valid);
  const double sigma = field.has_sigma() ? static_cast<double>(field.sigma_um.at(column, row)) : 0.0;
  if (mad == 0.0 && sigma == 0.0) return false;
  return std::abs(field.z_um.at(column, row) - median) > settings.limit * std::max(1.4826 * mad, sigma);
}

/// Noise, holes alone and in a block, spikes, steps, equal heights; far more than any codes of 16 bits reach.
HeightField rough_field(int width, int height, bool sigma, double holes) {
  HeightField field = make_field(width, height, 1.0, 1.0,
                                 [](double x, double y) { return 0.3 * x - 0.1 * y + (x > 20.0 ? 50.0 : 0.0); });
  add_noise(field, 0.2, 3);
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> uniform;
  for (double& z : field.z_um.pixels()) z += uniform(generator) < 0.05 ? 10.0 * uniform(generator) : 0.0;
  for (int row = 0; row < std::min(height, 9); ++row) {
    for (int column = 0; column < std::min(width, 9); ++column) field.z_um.at(column, row) = 7.0;
  }
  for (double& z : field.z_um.pixels()) z = uniform(generator) < 0.01 ? 1e6 * (uniform(generator) - 0.5) : z;
  for (int row = 20; row < std::min(height, 28); ++row) {
    for (int column = 0; column < std::min(width, 10); ++column) field.z_um.at(column, row) -= 1e5;
  }
  punch_holes(field, holes, 6);
  for (int row = height / 2; row < std::min(height / 2 + 12, height); ++row) {
    for (int column = width / 2; column < std::min(width / 2 + 6, width); ++column) {
      field.z_um.at(column, row) = (row + column) % 5 == 0 ? 3.0 * row : kHole;
    }
  }
  if (!sigma) return field;
  field.sigma_um = Plane<float>(width, height);
  for (float& s : field.sigma_um.pixels()) s = static_cast<float>(0.3 * uniform(generator));
  return field;
}

class OutlierGrid : public testing::TestWithParam<std::tuple<int, int, int, bool, double>> {};

TEST_P(OutlierGrid, RemovesExactlyWhatTheRuleSays) {
  const auto [width, height, window, sigma, holes] = GetParam();
  const HeightField before = rough_field(width, height, sigma, holes);
  HeightField field = before.clone();
  Plane<MaskReasons> reasons(width, height);
  for (const double limit : {0.4, 2.5, 6.0}) {
    field = before.clone();
    std::fill(reasons.pixels().begin(), reasons.pixels().end(), MaskReasons{0});
    std::size_t expected = 0;

    const OperationReport report = remove_outliers(field, {window, limit}, &reasons);

    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const bool outlier = is_outlier(before, column, row, {window, limit});
        EXPECT_EQ(reasons.at(column, row), outlier ? mask_reason::kOutlier : 0) << column << ' ' << row;
        EXPECT_EQ(field.is_hole(column, row), outlier || before.is_hole(column, row));
        expected += outlier ? 1U : 0U;
      }
    }
    EXPECT_EQ(report.points_removed, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, OutlierGrid,
                         testing::Combine(testing::Values(1, 2, 8, 41), testing::Values(1, 5, 37),
                                          testing::Values(3, 7, 9, 13), testing::Bool(),
                                          testing::Values(0.0, 0.1, 0.5)));

TEST(Outliers, DecideNothingWhereUnderHalfOfTheWindowIsValid) {
  HeightField field = make_field(3, 3, 1.0, 1.0, [](double x, double y) { return x + 0.1 * y; });
  field.z_um.at(1, 1) = 1000.0;
  for (const int column : {0, 1, 2}) field.z_um.at(column, 0) = kHole;
  HeightField fewer = field.clone();
  for (const int column : {0, 1}) fewer.z_um.at(column, 2) = kHole;

  EXPECT_EQ(remove_outliers(field, {3, 3.0}).points_removed, 1U);
  const OperationReport report = remove_outliers(fewer, {3, 3.0});

  EXPECT_EQ(report.points_removed, 0U);
  EXPECT_GT(value(report, "undecided_few_valid"), 0.0);
}

TEST(Outliers, LeaveRoundedHeightsWithoutAScaleAlone) {
  HeightField field = make_field(9, 9, 1.0, 1.0, [](double x, double) { return x == 4.5 ? 1.0 : 0.0; });

  const OperationReport report = remove_outliers(field, {5, 3.0});

  EXPECT_EQ(report.points_removed, 0U);
  EXPECT_EQ(value(report, "undecided_no_scale"), 9.0);
  EXPECT_EQ(report.warnings.size(), 1U);
}

TEST(Outliers, AreTheSameOnAnyNumberOfThreads) {
  HeightField one = rough_field(50, 200, false, 0.05);
  HeightField three = one.clone();
  WorkerPool pool(3);

  const OperationReport alone = remove_outliers(one, {7, 6.0});
  const OperationReport shared = remove_outliers(three, {7, 6.0}, nullptr, &pool);

  EXPECT_EQ(alone.points_removed, shared.points_removed);
  EXPECT_EQ(worst_difference(one.z_um, three.z_um), 0.0);
}

TEST(Outliers, RefuseSettingsOutOfRange) {
  HeightField field = rough_field(5, 5, false, 0.0);

  EXPECT_THROW((void)remove_outliers(field, {4, 6.0}), Error);
  EXPECT_THROW((void)remove_outliers(field, {1, 6.0}), Error);
  EXPECT_THROW((void)remove_outliers(field, {33, 6.0}), Error);
  EXPECT_THROW((void)remove_outliers(field, {7, 0.0}), Error);
}

}  // namespace
}  // namespace fvd::metrology
