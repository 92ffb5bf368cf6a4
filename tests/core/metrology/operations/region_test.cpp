#include "core/metrology/operations/region.hpp"

#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/operations/region_combine.hpp"
#include "core/metrology/operations/region_threshold.hpp"
#include "tests/core/metrology/operations/operation_fields.hpp"

namespace fvd::metrology {
namespace {

/// Rows of `#` inside and `.` outside, for eyes.
std::vector<std::string> picture(const Region& region) {
  std::vector<std::string> rows;
  for (int row = 0; row < region.height(); ++row) {
    rows.emplace_back();
    for (int column = 0; column < region.width(); ++column) rows.back() += region.at(column, row) != 0 ? '#' : '.';
  }
  return rows;
}

using Picture = std::vector<std::string>;

Region drawn(const Picture& rows) {
  Region region(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int row = 0; row < region.height(); ++row) {
    for (int column = 0; column < region.width(); ++column) {
      region.at(column, row) = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] == '#' ? 1 : 0;
    }
  }
  return region;
}

std::vector<PointUm> star(double x, double y, double radius, int corners, int jump) {
  std::vector<PointUm> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i * jump / corners + 0.3;
    points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return points;
}

bool same(const Region& left, const Region& right) {
  return std::equal(left.pixels().begin(), left.pixels().end(), right.pixels().begin(), right.pixels().end());
}

TEST(Region, OfARectangleHoldsTheCentresInItWithItsBorder) {
  const Grid grid{6, 4, 0.5, 2.0};  // centres at x 0.25, 0.75 .. 2.75 and y 1, 3, 5, 7

  const Region region = rectangle_region(grid, {0.75, 2.9, 1.0, 2.2});

  EXPECT_EQ(picture(region), (Picture{"......", ".###..", ".###..", "......"}));
}

TEST(Region, OfARectangleIsCutOffByTheImage) {
  const Grid grid{3, 2, 1.0, 1.0};

  EXPECT_EQ(picture(rectangle_region(grid, {-10.0, -10.0, 11.0, 100.0})), (Picture{"#..", "#.."}));
  EXPECT_EQ(count_points(rectangle_region(grid, {50.0, 0.0, 5.0, 5.0})), 0U);
  EXPECT_EQ(count_points(rectangle_region(grid, {-1e12, -1e12, 3e12, 3e12})), 6U);
}

TEST(Region, IgnoresRoundingOfAPitchAtItsBorder) {
  const Grid grid{100, 1, 0.1, 1.0};

  const Region region = rectangle_region(grid, {34.5 * 0.1, 0.0, 30.0 * 0.1, 1.0});

  EXPECT_EQ(count_points(region), 31U);
}

TEST(Region, OfACircleHoldsTheCentresInIt) {
  const Grid grid{5, 5, 1.0, 1.0};

  EXPECT_EQ(picture(circle_region(grid, {2.5, 2.5, 2.0})), (Picture{"..#..", ".###.", "#####", ".###.", "..#.."}));
  EXPECT_EQ(picture(circle_region(grid, {2.5, 2.5, 1.99})), (Picture{".....", ".###.", ".###.", ".###.", "....."}));
}

TEST(Region, OfACircleIsRoundInMicrometresNotInPixels) {
  const Grid grid{9, 3, 0.5, 2.0};

  EXPECT_EQ(picture(circle_region(grid, {2.25, 3.0, 2.0})), (Picture{"....#....", "#########", "....#...."}));
}

TEST(Region, OfAPolygonHoldsTheCentresInItWithItsBorder) {
  const Grid grid{5, 5, 1.0, 1.0};
  const std::vector<PointUm> triangle = {{0.5, 0.5}, {4.5, 4.5}, {0.5, 4.5}};

  EXPECT_EQ(picture(polygon_region(grid, triangle)), (Picture{"#....", "##...", "###..", "####.", "#####"}));
}

TEST(Region, OfAPolygonThatCrossesItselfIsInsideWhereSidesAreCrossedOddly) {
  const Grid grid{6, 6, 1.0, 1.0};
  const std::vector<PointUm> twice = {{0.0, 0.0}, {6.0, 0.0}, {6.0, 6.0}, {0.0, 6.0}, {0.0, 0.0},
                                      {2.0, 2.0}, {4.0, 2.0}, {4.0, 4.0}, {2.0, 4.0}, {2.0, 2.0}};

  EXPECT_EQ(picture(polygon_region(grid, twice)),
            (Picture{"######", "######", "##..##", "##..##", "######", "######"}));
}

TEST(Region, OfAPolygonAgreesWithTheAngleThatItSubtends) {
  const Grid grid{40, 30, 0.7, 1.1};
  const std::vector<PointUm> corners = {{3.0, 2.0}, {25.0, 5.5}, {14.0, 12.0}, {22.0, 30.0}, {2.5, 24.0}, {9.0, 14.0}};

  const Region region = polygon_region(grid, corners);

  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      double turned = 0.0;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const PointUm a = corners[i];
        const PointUm b = corners[(i + 1) % corners.size()];
        const double ax = a.x - (column + 0.5) * 0.7;
        const double ay = a.y - (row + 0.5) * 1.1;
        const double bx = b.x - (column + 0.5) * 0.7;
        const double by = b.y - (row + 0.5) * 1.1;
        turned += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
      }
      EXPECT_EQ(region.at(column, row) != 0, std::abs(turned) > std::numbers::pi) << column << ' ' << row;
    }
  }
}

TEST(Region, IsTheSameOnATransposedAndOnAMirroredSurface) {
  const Grid grid{61, 47, 0.5, 0.25};
  const Grid turned{47, 61, 0.25, 0.5};
  const auto corners = star(15.0, 6.0, 7.0, 7, 3);
  const std::vector<PointUm> on_centres = {{2.25, 1.125}, {10.25, 1.125}, {10.25, 9.125}, {6.25, 5.125}, {2.25, 9.125}};
  for (const auto& polygon : {corners, on_centres}) {
    std::vector<PointUm> swapped;
    std::vector<PointUm> flipped;
    for (const PointUm& p : polygon) {
      swapped.push_back({p.y, p.x});
      flipped.push_back({30.5 - p.x, p.y});
    }

    const Region region = polygon_region(grid, polygon);

    EXPECT_TRUE(same(polygon_region(turned, swapped), transposed(region)));
    EXPECT_TRUE(same(polygon_region(grid, flipped), mirrored(region)));
    EXPECT_TRUE(same(region_shrink(turned, transposed(region), 1.3), transposed(region_shrink(grid, region, 1.3))));
  }
  EXPECT_TRUE(same(circle_region(turned, {6.0, 15.25, 5.0}), transposed(circle_region(grid, {15.25, 6.0, 5.0}))));
  EXPECT_TRUE(same(rectangle_region(grid, {30.5 - 9.25, 2.0, 7.0, 4.125}),
                   mirrored(rectangle_region(grid, {2.25, 2.0, 7.0, 4.125}))));
}

TEST(Region, RefusesShapesWithoutAnInside) {
  const Grid grid{5, 5, 1.0, 1.0};
  const std::vector<PointUm> two = {{0.0, 0.0}, {3.0, 3.0}};
  const std::vector<PointUm> line = {{1.0, 0.0}, {2.0, 2.0}, {3.0, 4.0}, {1.5, 1.0}};
  const std::vector<PointUm> endless = {{0.0, 0.0}, {3.0, 3.0}, {0.0, std::numeric_limits<double>::infinity()}};

  EXPECT_THROW((void)polygon_region(grid, two), Error);
  EXPECT_THROW((void)polygon_region(grid, line), Error);
  EXPECT_THROW((void)polygon_region(grid, endless), Error);
  EXPECT_THROW((void)rectangle_region(grid, {0.0, 0.0, 0.0, 1.0}), Error);
  EXPECT_THROW((void)rectangle_region(grid, {kHole, 0.0, 1.0, 1.0}), Error);
  EXPECT_THROW((void)circle_region(grid, {0.0, 0.0, -1.0}), Error);
  EXPECT_THROW((void)mask_region(grid, Plane<std::uint8_t>(4, 5)), Error);
  EXPECT_THROW((void)region_shrink(grid, Region(5, 5), -1.0), Error);
}

TEST(Region, OfAMaskHoldsTheBrightPixels) {
  Plane<std::uint8_t> mask(2, 1);
  mask.at(1, 0) = 255;

  EXPECT_EQ(picture(mask_region({2, 1, 1.0, 1.0}, mask)), (Picture{".#"}));
}

TEST(Region, CombinesByLogic) {
  const Region left = drawn({"##.."});
  const Region right = drawn({"#.#."});

  EXPECT_EQ(picture(region_not(left)), (Picture{"..##"}));
  EXPECT_EQ(picture(region_union(left, right)), (Picture{"###."}));
  EXPECT_EQ(picture(region_intersection(left, right)), (Picture{"#..."}));
}

TEST(RegionShrink, KeepsThePointsFartherFromTheOutsideThanTheDistance) {
  const Grid grid{40, 30, 0.8, 1.3};
  std::mt19937_64 generator(5);
  std::bernoulli_distribution outside(0.01);
  Region region(40, 30);
  for (std::uint8_t& inside : region.pixels()) inside = outside(generator) ? 0 : 1;
  for (const double shrink_um : {0.0, 0.7, 0.8, 1.3, 2.9, 4.0, 100.0}) {
    const Region shrunk = region_shrink(grid, region, shrink_um);

    for (int row = 0; row < 30; ++row) {
      for (int column = 0; column < 40; ++column) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int y = 0; y < 30; ++y) {
          for (int x = 0; x < 40; ++x) {
            if (region.at(x, y) == 0) nearest = std::min(nearest, std::hypot((x - column) * 0.8, (y - row) * 1.3));
          }
        }
        EXPECT_EQ(shrunk.at(column, row) != 0, nearest > shrink_um + 1e-7) << shrink_um << ' ' << column << ' ' << row;
      }
    }
  }
}

TEST(RegionShrink, DoesNotCountWhatLiesBeyondTheImage) {
  const Grid grid{6, 2, 1.0, 1.0};

  EXPECT_EQ(picture(region_shrink(grid, drawn({"####..", "####.."}), 1.0)), (Picture{"###...", "###..."}));
  EXPECT_EQ(count_points(region_shrink(grid, Region(6, 2, 1), 50.0)), 12U);
}

TEST(ThresholdRegion, HoldsTheHeightsBetweenItsBounds) {
  const HeightField field = make_field(5, 1, 1.0, 1.0, [](double x, double) { return x == 2.5 ? kHole : x; });

  const ThresholdRegion found = threshold_region(field, {1.5, 3.5, false});

  EXPECT_EQ(picture(found.region), (Picture{".#.#."}));
  EXPECT_EQ(found.points, 2U);
  EXPECT_EQ(found.parts, 2U);
}

HeightField heights(const Picture& rows) {
  const Region region = drawn(rows);
  return make_field(region.width(), region.height(), 1.0, 1.0, [&](double x, double y) {
    return region.at(static_cast<int>(x), static_cast<int>(y)) != 0 ? 10.0 : 0.0;
  });
}

TEST(ThresholdRegion, KeepsTheLargestPartWhoseParentsMeetLate) {
  const ThresholdRegion found =
      threshold_region(heights({"#.#.###", "#.#...#", "###..#.", ".....##"}), {5.0, std::nullopt, true});

  EXPECT_EQ(picture(found.region), (Picture{"#.#....", "#.#....", "###....", "......."}));
  EXPECT_EQ(found.points, 7U);
  EXPECT_EQ(found.parts, 3U);
  EXPECT_FALSE(found.tie);
}

TEST(ThresholdRegion, DoesNotConnectAcrossCorners) {
  EXPECT_EQ(threshold_region(heights({"##..", "..##"}), {5.0, std::nullopt, false}).parts, 2U);
  EXPECT_EQ(threshold_region(heights({"..##", "##.."}), {5.0, std::nullopt, false}).parts, 2U);
  EXPECT_EQ(threshold_region(heights({".###", "##.."}), {5.0, std::nullopt, false}).parts, 1U);
}

TEST(ThresholdRegion, SaysThatTwoPartsAreEquallyLarge) {
  const ThresholdRegion found = threshold_region(heights({"##.##"}), {std::nullopt, 20.0, true});
  const ThresholdRegion tied = threshold_region(heights({"##.##"}), {5.0, std::nullopt, true});

  EXPECT_FALSE(found.tie);
  EXPECT_TRUE(tied.tie);
  EXPECT_EQ(picture(tied.region), (Picture{"##..."}));
}

TEST(ThresholdRegion, RefusesBoundsThatHoldNothing) {
  const HeightField field = heights({"#"});

  EXPECT_THROW((void)threshold_region(field, {}), Error);
  EXPECT_THROW((void)threshold_region(field, {2.0, 1.0, false}), Error);
  EXPECT_THROW((void)threshold_region(field, {kHole, std::nullopt, false}), Error);
}

}  // namespace
}  // namespace fvd::metrology
