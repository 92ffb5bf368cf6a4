#include "core/metrology/profile/profile_heights.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

const double kHole = std::nan("");

TEST(RootMeanSquareSlope, IsThatOfALineBesideHolesAndEnds) {
  std::vector<double> z;
  for (int i = 0; i < 30; ++i) z.push_back(4.0 - 0.3 * i);
  for (const std::size_t hole : {0u, 4u, 10u, 17u}) z[hole] = kHole;  // stretches of 3, 5, 6 and 12 points

  EXPECT_NEAR(root_mean_square_slope(z, 0.5).value(), 0.6, 1e-14);
}

TEST(RootMeanSquareSlope, TakesTheHighestOrderThatFits) {
  // z = x^5. The middle of five points: (8 * 2 - 64) / 12 = -4; beside it three points: 16.
  const std::vector<double> five{kHole, -32, -1, 0, 1, 32, kHole};
  // The middle of seven: exactly 0; beside it five points: (8 * 32 - (243 - -1)) / 12 = 1; then three: 122.
  const std::vector<double> seven{-243, -32, -1, 0, 1, 32, 243};

  EXPECT_NEAR(root_mean_square_slope(five, 1.0).value(), std::sqrt((16.0 * 16.0 * 2.0 + 4.0 * 4.0) / 3.0), 1e-12);
  EXPECT_NEAR(root_mean_square_slope(seven, 1.0).value(), std::sqrt((121.0 * 121.0 * 2.0 + 1.0 * 2.0) / 5.0), 1e-12);
}

TEST(RootMeanSquareSlope, IsAbsentWithoutNeighbours) {
  EXPECT_FALSE(root_mean_square_slope(std::vector<double>{1.0, kHole, 2.0, 3.0, kHole}, 1.0));
  EXPECT_FALSE(root_mean_square_slope({}, 1.0));
}

TEST(SumHeights, LeavesHolesOut) {
  const HeightSums sums = sum_heights(std::vector<double>{1.0, kHole, -3.0});

  EXPECT_EQ(sums.points, 2u);
  EXPECT_EQ(sums.mean_absolute_um, 2.0);
  EXPECT_NEAR(sums.root_mean_square_um, std::sqrt(5.0), 1e-15);
  EXPECT_NEAR(sums.cubes, -13.0 / (5.0 * std::sqrt(5.0)), 1e-15);
  EXPECT_NEAR(sums.fourths, 41.0 / 25.0, 1e-15);
  EXPECT_EQ(sums.highest_um, 1.0);
  EXPECT_EQ(sums.deepest_um, 3.0);
}

TEST(LessLine, TakesALineOffBesideHoles) {
  std::vector<double> z;
  for (int i = 0; i < 20; ++i) z.push_back(7.0 + 0.25 * i);
  z[3] = z[11] = kHole;

  const std::vector<double> rest = less_line(z);

  for (std::size_t i = 0; i < z.size(); ++i) {
    ASSERT_EQ(std::isnan(rest[i]), std::isnan(z[i]));
    if (!std::isnan(z[i])) {
      EXPECT_NEAR(rest[i], 0.0, 1e-12);
    }
  }
  EXPECT_EQ(longest_hole(std::vector<double>{kHole, 1.0, kHole, kHole, 2.0, kHole}), 2u);
}

}  // namespace
}  // namespace fvd::metrology
