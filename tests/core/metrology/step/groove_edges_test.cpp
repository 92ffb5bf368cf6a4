#include "core/metrology/step/groove_edges.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/core/metrology/step/step_fields.hpp"

namespace fvd::metrology {
namespace {

/// height(x) at the places (i + 0.5) pitch.
template <typename Height>
std::vector<double> make_trace(int points, double pitch_um, const Height& height) {
  std::vector<double> trace;
  for (int i = 0; i < points; ++i) trace.push_back(height((i + 0.5) * pitch_um));
  return trace;
}

/// A groove between 30 and 75 um with walls that take `wall_um` each.
double walled(double x, double depth_um, double wall_um) {
  const double from_wall = std::min(x - 30.0, 75.0 - x);
  return -depth_um * std::clamp(from_wall / wall_um + 0.5, 0.0, 1.0);
}

TEST(GrooveEdges, AreTheMiddlesOfTheWalls) {
  for (const int lag : {1, 2, 5, 9}) {
    for (const double wall : {0.01, 6.0, 12.0}) {
      const auto trace = make_trace(200, 0.5, [&](double x) { return 0.05 * x + walled(x, 10.0, wall); });

      const GrooveEdges edges = given(find_groove_edges(trace, 0.5, lag));

      EXPECT_NEAR(edges.left_um, 30.0, 1e-9) << lag << ", " << wall;
      EXPECT_NEAR(edges.right_um, 75.0, 1e-9) << lag << ", " << wall;
    }
  }
}

TEST(GrooveEdges, AreTheSameForARidge) {
  const auto trace = make_trace(200, 0.5, [](double x) { return 0.05 * x - walled(x, 10.0, 4.0); });

  const GrooveEdges edges = given(find_groove_edges(trace, 0.5, 3));

  EXPECT_NEAR(edges.left_um, 30.0, 1e-9);
  EXPECT_NEAR(edges.right_um, 75.0, 1e-9);
}

TEST(GrooveEdges, AreFoundWhereTheWallsAreHoles) {
  const auto trace = make_trace(200, 0.5, [](double x) {
    return std::min(std::abs(x - 30.0), std::abs(x - 75.0)) < 4.0 ? kHole : walled(x, 10.0, 1.0);
  });

  const GrooveEdges edges = given(find_groove_edges(trace, 0.5, 9));

  EXPECT_NEAR(edges.left_um, 30.0, 1e-9);
  EXPECT_NEAR(edges.right_um, 75.0, 1e-9);
}

TEST(GrooveEdges, AreNotFoundAcrossLongGaps) {
  const auto trace = make_trace(200, 0.5, [](double x) {
    return std::min(std::abs(x - 30.0), std::abs(x - 75.0)) < 6.0 ? kHole : walled(x, 10.0, 1.0);
  });

  const auto outcome = find_groove_edges(trace, 0.5, 9);

  EXPECT_EQ(refused(outcome).code, StepRefusalCode::kNoEdges);
}

TEST(GrooveEdges, HaveToStandOutOfTheNoise) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto rough = [&](double depth) {
    return make_trace(400, 0.25, [&](double x) { return walled(x, depth, 0.5) + noise(generator); });
  };

  // Differences of white noise scatter by 1.4; the walls have to exceed five times of it.
  const auto shallow = find_groove_edges(rough(3.0), 0.25, 3);
  const auto deep = find_groove_edges(rough(20.0), 0.25, 3);

  EXPECT_EQ(refused(shallow).code, StepRefusalCode::kNoEdges);
  EXPECT_NEAR(given(deep).left_um, 30.0, 0.75);
  EXPECT_NEAR(given(deep).right_um, 75.0, 0.75);
}

TEST(GrooveEdges, AreRefusedWithoutARiseAndAFall) {
  const auto flat = make_trace(100, 1.0, [](double) { return 4.0; });
  const auto tilted = make_trace(100, 1.0, [](double x) { return 0.1 * x; });
  const auto single = make_trace(100, 1.0, [](double x) { return x < 50.0 ? 0.0 : 10.0; });
  const auto empty = make_trace(100, 1.0, [](double) { return kHole; });

  for (const auto& trace : {flat, tilted, single, empty, std::vector<double>{1.0}}) {
    EXPECT_EQ(refused(find_groove_edges(trace, 1.0, 5)).code, StepRefusalCode::kNoEdges);
  }
}

TEST(GrooveEdges, AreFoundOnASteepTilt) {
  // The tilt is steeper than the wall that falls, so that the trace rises everywhere.
  const auto trace = make_trace(200, 0.5, [](double x) { return 0.8 * x + walled(x, 3.0, 4.0); });

  const GrooveEdges edges = given(find_groove_edges(trace, 0.5, 3));

  EXPECT_NEAR(edges.left_um, 30.0, 1e-9);
  EXPECT_NEAR(edges.right_um, 75.0, 1e-9);
}

TEST(GrooveEdges, AreThoseOfTheFirstOfEqualGrooves) {
  const auto trace =
      make_trace(400, 0.5, [](double x) { return walled(x, 10.0, 0.01) + walled(x - 100.0, 10.0, 0.01); });

  const GrooveEdges edges = given(find_groove_edges(trace, 0.5, 3));

  EXPECT_NEAR(edges.left_um, 30.0, 1e-9);
  EXPECT_NEAR(edges.right_um, 75.0, 1e-9);
}

TEST(MedianTrace, TakesTheMedianOfTheBand) {
  HeightField field =
      make_field(4, 6, 1.0, 1.0, [](double x, double y) { return 10.0 * std::floor(x) + std::floor(y); });
  field.z_um.at(1, 2) = kHole;
  for (const int row : {1, 2, 3}) field.z_um.at(2, row) = kHole;
  for (const int row : {1, 2}) field.z_um.at(3, row) = kHole;
  field.z_um.at(0, 5) = 1e6;

  const std::vector<double> trace = median_trace(field, Across::kX, 1, 4);
  const std::vector<double> across = median_trace(transposed(field), Across::kY, 1, 4);

  ASSERT_EQ(trace.size(), 4U);
  EXPECT_EQ(trace[0], 2.5);
  EXPECT_EQ(trace[1], 13.0);
  EXPECT_TRUE(std::isnan(trace[2]));
  EXPECT_EQ(trace[3], 33.5);
  EXPECT_EQ(across[1], 13.0);
}

}  // namespace
}  // namespace fvd::metrology
