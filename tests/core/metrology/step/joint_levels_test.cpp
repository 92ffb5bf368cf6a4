#include "core/metrology/step/joint_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "tests/core/metrology/step/step_fields.hpp"

namespace fvd::metrology {
namespace {

/// Two regions of columns in rows: lower from..to, upper from..to, last included.
PointGroups two_groups(int height, int lower_from, int lower_to, int upper_from, int upper_to) {
  PointGroups groups{lower_from, 0, Plane<std::uint8_t>(upper_to - lower_from + 1, height), 2};
  for (int row = 0; row < height; ++row) {
    for (int x = lower_from; x <= lower_to; ++x) groups.group.at(x - lower_from, row) = 1;
    for (int x = upper_from; x <= upper_to; ++x) groups.group.at(x - lower_from, row) = 2;
  }
  return groups;
}

/// Slopes and levels by the normal equations with an unknown a level, in long double.
std::array<long double, 4> by_normal_equations(const HeightField& field, const PointGroups& groups) {
  std::array<std::array<long double, 5>, 4> m{};
  for (int row = 0; row < groups.group.height(); ++row) {
    for (int column = 0; column < groups.group.width(); ++column) {
      const int group = groups.group.at(column, row);
      if (group == 0 || field.is_hole(groups.left + column, groups.top + row)) continue;
      const std::array<double, 5> of_point{field.x_um(groups.left + column), field.y_um(groups.top + row),
                                           group == 1 ? 1.0 : 0.0, group == 2 ? 1.0 : 0.0,
                                           field.z_um.at(groups.left + column, groups.top + row)};
      std::array<long double, 5> line{};
      std::transform(of_point.begin(), of_point.end(), line.begin(),
                     [](double value) { return static_cast<long double>(value); });
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 5; ++j) m[i][j] += line[i] * line[j];
      }
    }
  }
  for (std::size_t pivot = 0; pivot < 4; ++pivot) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == pivot) continue;
      const long double factor = m[i][pivot] / m[pivot][pivot];
      for (std::size_t j = 0; j < 5; ++j) m[i][j] -= factor * m[pivot][j];
    }
  }
  return {m[0][4] / m[0][0], m[1][4] / m[1][1], m[2][4] / m[2][2], m[3][4] / m[3][3]};
}

TEST(JointLevels, AgreesWithTheNormalEquations) {
  HeightField field = make_field(60, 25, 0.7, 1.3,
                                 [](double x, double y) { return 4.0 + 0.03 * x - 0.02 * y + (x > 20.0 ? 7.0 : 0.0); });
  add_white_noise(field, 0.5, 3);
  punch_holes(field, 0.2, 4);
  const PointGroups groups = two_groups(25, 2, 24, 33, 57);

  const auto levels = JointLevels::fit(field, groups, SlopeAxes::kBoth);

  ASSERT_TRUE(levels.has_value());
  const auto [a, b, low, high] = by_normal_equations(field, groups);
  EXPECT_NEAR(levels->slope_x(), static_cast<double>(a), 1e-13);
  EXPECT_NEAR(levels->slope_y(), static_cast<double>(b), 1e-13);
  EXPECT_NEAR(levels->difference_um(2, 1), static_cast<double>(high - low), 1e-11);
  EXPECT_NEAR(levels->difference_um(1, 2), static_cast<double>(low - high), 1e-11);
}

TEST(JointLevels, StatesTheKnownCorrelationFactors) {
  constexpr int kLength = 600;
  struct Case {
    int gap;  // on each side of the step
    double factor;
  };
  for (const Case& expected :
       {Case{0, 2.0}, Case{kLength / 6, 2.5166}, Case{kLength / 3, 3.0551}, Case{kLength, 5.2915}}) {
    const int upper = kLength + 2 * expected.gap;
    const HeightField field = make_field(upper + kLength, 2, 1.0, 1.0, [](double x, double) { return x; });
    const PointGroups groups = two_groups(2, 0, kLength - 1, upper, upper + kLength - 1);

    const auto levels = JointLevels::fit(field, groups, SlopeAxes::kBoth);

    ASSERT_TRUE(levels.has_value());
    EXPECT_NEAR(levels->correlation_factor(2, 1), expected.factor, 5e-5) << expected.gap;
  }
}

TEST(JointLevels, TakesTheSlopeFromTheGroupsThatAreAskedFor) {
  // The second group has another slope than the first.
  const HeightField field =
      make_field(40, 8, 1.0, 1.0, [](double x, double y) { return x < 20.0 ? 0.1 * x + 0.2 * y : 0.5 * x - 0.3 * y; });
  const PointGroups groups = two_groups(8, 0, 19, 20, 39);

  const auto first = JointLevels::fit(field, groups, SlopeAxes::kBoth, {1});
  const auto second = JointLevels::fit(field, groups, SlopeAxes::kBoth, {2});

  ASSERT_TRUE(first.has_value() && second.has_value());
  EXPECT_NEAR(first->slope_x(), 0.1, 1e-12);
  EXPECT_NEAR(first->slope_y(), 0.2, 1e-12);
  EXPECT_NEAR(second->slope_x(), 0.5, 1e-12);
  EXPECT_NEAR(second->slope_y(), -0.3, 1e-12);
}

TEST(JointLevels, KeepsToOneDirectionWhereOneIsAskedFor) {
  const HeightField field = make_field(40, 8, 1.0, 1.0, [](double x, double y) { return 0.1 * x + 0.2 * y; });
  const PointGroups groups = two_groups(8, 0, 9, 20, 39);

  const auto x_only = JointLevels::fit(field, groups, SlopeAxes::kX);
  const auto y_only = JointLevels::fit(field, groups, SlopeAxes::kY);
  const auto none = JointLevels::fit(field, groups, SlopeAxes::kNone);

  ASSERT_TRUE(x_only.has_value() && y_only.has_value() && none.has_value());
  EXPECT_NEAR(x_only->slope_x(), 0.1, 1e-13);
  EXPECT_EQ(x_only->slope_y(), 0.0);
  EXPECT_NEAR(x_only->difference_um(2, 1), 0.0, 1e-13);
  EXPECT_EQ(y_only->slope_x(), 0.0);
  EXPECT_NEAR(y_only->slope_y(), 0.2, 1e-13);
  EXPECT_NEAR(y_only->difference_um(2, 1), 2.5, 1e-13);
  EXPECT_NEAR(none->difference_um(2, 1), 2.5, 1e-13);
  EXPECT_EQ(none->correlation_factor(2, 1), 1.0);
}

TEST(JointLevels, IsAbsentWhereTheSlopeIsNotDefined) {
  const auto slope = [](double x, double y) { return x + y; };
  HeightField one_row = make_field(40, 1, 1.0, 1.0, slope);
  HeightField diagonal = make_field(10, 10, 1.0, 1.0, slope);
  PointGroups on_diagonal{0, 0, Plane<std::uint8_t>(10, 10), 1};
  for (int i = 0; i < 10; ++i) on_diagonal.group.at(i, i) = 1;
  HeightField without_second = make_field(40, 3, 1.0, 1.0, [](double x, double) { return x < 20.0 ? 0.0 : kHole; });

  EXPECT_FALSE(JointLevels::fit(one_row, two_groups(1, 0, 9, 20, 29), SlopeAxes::kBoth).has_value());
  EXPECT_TRUE(JointLevels::fit(one_row, two_groups(1, 0, 9, 20, 29), SlopeAxes::kX).has_value());
  EXPECT_FALSE(JointLevels::fit(diagonal, on_diagonal, SlopeAxes::kBoth).has_value());
  EXPECT_FALSE(JointLevels::fit(without_second, two_groups(3, 0, 9, 20, 29), SlopeAxes::kBoth).has_value());
}

TEST(JointLevels, WeightsReproduceSlopesAndDifferences) {
  HeightField field = make_field(50, 12, 0.5, 2.0, [](double x, double y) { return 0.2 * x - 0.1 * y; });
  add_white_noise(field, 1.0, 5);
  punch_holes(field, 0.15, 6);
  const PointGroups groups = two_groups(12, 4, 18, 26, 49);
  const auto sum = [&](const WeightMap& map) {
    double total = 0.0;
    for (int row = 0; row < field.height(); ++row) {
      for (int column = 0; column < field.width(); ++column) {
        if (map.at(column, row) != 0.0) total += map.at(column, row) * field.z_um.at(column, row);
      }
    }
    return total;
  };

  for (const std::vector<int>& from : {std::vector<int>{}, std::vector<int>{1}, std::vector<int>{2}}) {
    const auto levels = JointLevels::fit(field, groups, SlopeAxes::kBoth, from);

    ASSERT_TRUE(levels.has_value());
    EXPECT_NEAR(sum(levels->weights(field, groups, 2, 1, 1.0, {0.0, 0.0})), levels->difference_um(2, 1), 1e-11);
    EXPECT_NEAR(sum(levels->weights(field, groups, 2, 1, 0.0, {1.0, 0.0})), levels->slope_x(), 1e-12);
    EXPECT_NEAR(sum(levels->weights(field, groups, 2, 1, 0.0, {0.0, 1.0})), levels->slope_y(), 1e-12);
  }
}

}  // namespace
}  // namespace fvd::metrology
