#include "core/metrology/areal/material_ratio.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

#include "tests/core/metrology/areal/slow_curve.hpp"

namespace fvd::metrology {
namespace {

constexpr int kQuantiles = 1000000;

std::vector<double> sinusoid(int count) {
  std::vector<double> heights;
  for (int i = 0; i < count; ++i) heights.push_back(5.0 * std::sin(2.0 * std::numbers::pi * (i + 0.5) / count));
  return sorted_descending(heights);
}

std::vector<double> ramp(int count) {
  std::vector<double> heights;
  for (int i = 0; i < count; ++i) heights.push_back(10.0 * (i + 0.5) / count - 5.0);
  return sorted_descending(heights);
}

std::vector<double> normal_quantiles(int count) {
  const boost::math::normal_distribution<double> normal;
  std::vector<double> heights;
  for (int i = 0; i < count; ++i) heights.push_back(boost::math::quantile(normal, (i + 0.5) / count));
  return sorted_descending(heights);
}

TEST(MaterialRatioCurve, GivesTheCoreOfASinusoidAndSaysThatItTies) {
  const MaterialRatioCurve curve(sinusoid(100000));

  const CoreParameters core = curve.core();

  EXPECT_NEAR(core.core_um, 8.637288, 1e-6);
  EXPECT_EQ(core.ratio1_percent, 0.0);
  EXPECT_NEAR(core.ratio2_percent, 75.92982, 1e-5);
  EXPECT_EQ(core.peak_um, 0.0);
  EXPECT_NEAR(core.valley_um, 1.799273, 1e-6);
  EXPECT_EQ(core.secant_percent, 0.0);
  EXPECT_TRUE(core.tie);
}

TEST(MaterialRatioCurve, GivesTheVolumesOfASinusoid) {
  const MaterialRatioCurve curve(sinusoid(100000));

  EXPECT_NEAR(curve.material_volume_um(10.0), 0.01628756, 1e-8);
  EXPECT_NEAR(curve.material_volume_um(80.0) - curve.material_volume_um(10.0), 4.155270, 1e-6);
  EXPECT_NEAR(curve.void_volume_um(10.0) - curve.void_volume_um(80.0), 4.645098, 1e-6);
  EXPECT_NEAR(curve.void_volume_um(80.0), 0.1264723, 1e-7);
  EXPECT_NEAR(curve.height_at_um(2.5) - curve.height_at_um(50.0), 4.984587, 1e-6);
}

TEST(MaterialRatioCurve, ConvergesWithTheSquareOfTheNumberOfPoints) {
  // N points have N / 2 heights, each twice; the closed form's bound is 60 / N^2 relative.
  for (const int count : {200, 1000, 5000}) {
    const CoreParameters core = MaterialRatioCurve(sinusoid(count)).core();

    const double bound = 60.0 / (static_cast<double>(count) * count);
    EXPECT_NEAR(core.core_um, 8.637288, 8.637288 * bound + 1e-6) << count;
    EXPECT_NEAR(core.ratio2_percent, 75.92982, 75.92982 * bound + 1e-5) << count;
    EXPECT_NEAR(core.valley_um, 1.799273, 1.799273 * 2.0 * bound + 1e-6) << count;
  }
}

TEST(MaterialRatioCurve, MirrorsASinusoidsCore) {
  // Upside down the sinusoid is itself, and the first of its two secants is the left one again.
  std::vector<double> heights = sinusoid(1000);
  for (double& height : heights) height = -height;

  const CoreParameters core = MaterialRatioCurve(sorted_descending(heights)).core();

  EXPECT_EQ(core.ratio1_percent, 0.0);
  EXPECT_TRUE(core.tie);
}

TEST(MaterialRatioCurve, TakesARampForACoreOnly) {
  const MaterialRatioCurve curve(ramp(1000));

  const CoreParameters core = curve.core();

  EXPECT_NEAR(core.core_um, 10.0, 1e-9);
  EXPECT_NEAR(core.ratio1_percent, 0.0, 1e-9);
  EXPECT_NEAR(core.ratio2_percent, 100.0, 1e-9);
  EXPECT_NEAR(core.peak_um, 0.0, 1e-9);
  EXPECT_NEAR(core.valley_um, 0.0, 1e-9);
  EXPECT_FALSE(core.tie);  // every secant is on the same line
  EXPECT_NEAR(curve.material_volume_um(10.0), 0.05, 5.0 / (1000.0 * 1000.0));
  EXPECT_NEAR(curve.material_volume_um(80.0) - curve.material_volume_um(10.0), 3.15, 1e-9);
  EXPECT_NEAR(curve.void_volume_um(10.0) - curve.void_volume_um(80.0), 3.85, 1e-9);
  EXPECT_NEAR(curve.void_volume_um(80.0), 0.2, 5.0 / (1000.0 * 1000.0));
  EXPECT_NEAR(curve.height_at_um(2.5) - curve.height_at_um(50.0), 4.75, 1e-9);
}

TEST(MaterialRatioCurve, TakesARampWithEveryHeightManyTimesForACoreOnly) {
  std::vector<double> heights;
  for (int row = 0; row < 50; ++row) {
    for (const double height : ramp(1000)) heights.push_back(height);
  }

  const CoreParameters core = MaterialRatioCurve(sorted_descending(heights)).core();

  EXPECT_NEAR(core.core_um, 10.0, 1e-9);
  EXPECT_NEAR(core.ratio1_percent, 0.0, 1e-9);
  EXPECT_NEAR(core.ratio2_percent, 100.0, 1e-9);
}

TEST(MaterialRatioCurve, GivesTheCoreAndTheVolumesOfNormalHeights) {
  const MaterialRatioCurve curve(normal_quantiles(kQuantiles));

  const CoreParameters core = curve.core();

  EXPECT_NEAR(core.core_um, 2.622003, 1e-6);
  EXPECT_NEAR(core.peak_um, 0.9369847, 2e-6);
  EXPECT_NEAR(core.valley_um, 0.9369847, 2e-6);
  EXPECT_NEAR(core.ratio1_percent, 9.492867, 1e-5);
  EXPECT_NEAR(core.ratio2_percent, 90.507133, 1e-5);
  EXPECT_NEAR(core.secant_percent, 30.0, 0.01);
  EXPECT_FALSE(core.tie);
  EXPECT_NEAR(curve.material_volume_um(10.0), 0.04734318, 1e-7);
  EXPECT_NEAR(curve.material_volume_um(80.0) - curve.material_volume_um(10.0), 0.9059157, 1e-6);
  EXPECT_NEAR(curve.void_volume_um(10.0) - curve.void_volume_um(80.0), 1.2172571, 1e-6);
  EXPECT_NEAR(curve.void_volume_um(80.0), 0.1116377, 2e-7);
  EXPECT_NEAR(curve.height_at_um(2.5) - curve.height_at_um(50.0), 1.959964, 1e-6);
}

TEST(MaterialRatioCurve, AgreesWithSearchingAndClipping) {
  std::mt19937 random(3);
  std::gamma_distribution<double> skewed(2.0, 1.0);
  std::vector<double> heights;
  for (int i = 0; i < 1203; ++i) heights.push_back(skewed(random) - 2.0);
  const std::vector<double> descending = sorted_descending(heights);
  const SlowCurve slow(descending);
  const auto [drop, begin] = slow.smallest_drop();
  const long double slope = drop / 0.4L;
  const long double top = slow.beyond(begin) + slope * begin;
  const long double ratio1 = slow.ratio_of(top);
  const long double ratio2 = slow.ratio_of(top - slope);

  const MaterialRatioCurve curve(descending);
  const CoreParameters core = curve.core();

  const auto expect = [](double value, long double exact) {
    EXPECT_NEAR(value, static_cast<double>(exact), 1e-9 * std::abs(static_cast<double>(exact)));
  };
  expect(core.core_um, slope);
  expect(core.core_top_um, top);
  expect(core.ratio1_percent, 100.0L * ratio1);
  expect(core.ratio2_percent, 100.0L * ratio2);
  expect(core.peak_um, 2.0L * slow.area(top, 1.0L) / ratio1);
  expect(core.valley_um, 2.0L * slow.area(top - slope, -1.0L) / (1.0L - ratio2));
  expect(curve.material_volume_um(13.0), slow.area(slow.at(0.13L), 1.0L));
  expect(curve.void_volume_um(77.0), slow.area(slow.at(0.77L), -1.0L));
  expect(curve.height_at_um(41.7), slow.at(0.417L));
  expect(curve.ratio_at_percent(0.3), 100.0L * slow.ratio_of(0.3L));
}

TEST(MaterialRatioCurve, KeepsTwoLevelsLevel) {
  std::vector<double> heights(400, 10.0);
  heights.resize(1000, 0.0);
  const MaterialRatioCurve curve(heights);

  EXPECT_EQ(curve.height_at_um(5.0), 10.0);
  EXPECT_EQ(curve.height_at_um(39.0), 10.0);
  EXPECT_EQ(curve.height_at_um(41.0), 0.0);
  EXPECT_NEAR(curve.ratio_at_percent(3.0), 40.0, 0.06);
  EXPECT_NEAR(curve.material_volume_um(80.0), 4.0, 1e-9);
  EXPECT_NEAR(curve.void_volume_um(10.0), 6.0, 1e-9);
}

TEST(MaterialRatioCurve, TakesAWholePlateauIntoTheCore) {
  std::vector<double> heights(500, 10.0);
  heights.resize(1000, 0.0);

  const CoreParameters core = MaterialRatioCurve(heights).core();

  EXPECT_EQ(core.core_um, 0.0);
  EXPECT_EQ(core.ratio1_percent, 0.0);
  EXPECT_NEAR(core.ratio2_percent, 50.0, 0.06);
  EXPECT_NEAR(core.valley_um, 20.0, 0.03);
  EXPECT_TRUE(core.tie);
}

TEST(MaterialRatioCurve, FindsASmallestSecantAtTheRightEnd) {
  // Steep at first, then ever shallower: the last 40 % fall least.
  std::vector<double> heights;
  for (int i = 0; i < 2000; ++i) heights.push_back(std::pow(1.0 - (i + 0.5) / 2000.0, 3));

  const CoreParameters core = MaterialRatioCurve(heights).core();

  EXPECT_NEAR(core.secant_percent, 60.0, 1e-9);
  EXPECT_NEAR(core.core_um, 0.064 / 0.4, 1e-6);
  EXPECT_NEAR(core.core_top_um, 0.16, 1e-6);
  EXPECT_NEAR(core.ratio1_percent, 100.0 * (1.0 - std::cbrt(0.16)), 1e-4);
  EXPECT_EQ(core.ratio2_percent, 100.0);
}

TEST(MaterialRatioCurve, FindsASmallestSecantAnywhere) {
  // A shallow stretch of 40 % between steep ones, which begins at several places.
  for (const double begin : {0.02, 0.13, 0.4, 0.58}) {
    std::vector<double> heights;
    for (int i = 0; i < 2000; ++i) {
      const double ratio = (i + 0.5) / 2000.0;
      heights.push_back(-3.0 * std::min(ratio, begin) - 0.1 * std::clamp(ratio - begin, 0.0, 0.4) -
                        5.0 * std::max(ratio - begin - 0.4, 0.0));
    }

    const CoreParameters core = MaterialRatioCurve(heights).core();

    EXPECT_NEAR(core.secant_percent, 100.0 * begin, 0.06) << begin;
    EXPECT_NEAR(core.core_um, 0.1, 0.005) << begin;
    EXPECT_FALSE(core.tie) << begin;
  }
}

TEST(MaterialRatioCurve, ReadsRatiosFromTopToBottom) {
  const MaterialRatioCurve curve(std::vector<double>{4.0, 3.0, 2.0, 1.0});

  EXPECT_EQ(curve.ratio_at_percent(5.0), 0.0);
  EXPECT_EQ(curve.ratio_at_percent(4.0), 12.5);
  EXPECT_EQ(curve.ratio_at_percent(2.5), 50.0);
  EXPECT_EQ(curve.ratio_at_percent(1.0), 100.0);
  EXPECT_EQ(curve.height_at_um(0.0), 4.0);
  EXPECT_EQ(curve.height_at_um(25.0), 3.5);
  EXPECT_EQ(curve.height_at_um(100.0), 1.0);
}

TEST(MaterialRatioCurve, TakesOneHeightForAFlatSurface) {
  const MaterialRatioCurve curve(std::vector<double>(5, 2.0));

  const CoreParameters core = curve.core();

  EXPECT_EQ(core.core_um, 0.0);
  EXPECT_EQ(core.peak_um, 0.0);
  EXPECT_EQ(core.valley_um, 0.0);
  EXPECT_EQ(curve.height_at_um(50.0), 2.0);
  EXPECT_EQ(MaterialRatioCurve(std::vector<double>{7.0}).core().core_top_um, 7.0);
}

TEST(MaterialRatio, CountsHeightsAtOrAbove) {
  const std::vector<double> descending = {4.0, 3.0, 3.0, 1.0};

  EXPECT_EQ(material_ratio_percent(descending, 4.5), 0.0);
  EXPECT_EQ(material_ratio_percent(descending, 3.0), 75.0);
  EXPECT_EQ(material_ratio_percent(descending, 2.0), 75.0);
  EXPECT_EQ(material_ratio_percent(descending, 1.0), 100.0);
}

TEST(SortedDescending, SortsAsComparisonsDo) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (const std::size_t count : {0U, 1U, 100U, 4095U, 4096U, 50000U}) {
    std::vector<double> heights;
    for (std::size_t i = 0; i < count; ++i) heights.push_back(normal(random) * std::pow(10.0, 20.0 * normal(random)));
    std::vector<double> expected = heights;
    std::sort(expected.begin(), expected.end(), std::greater<>());

    EXPECT_EQ(sorted_descending(heights), expected) << count;
  }
}

TEST(SortedDescending, GivesOneZero) {
  std::vector<double> heights(5000, -0.0);

  for (const double zero : sorted_descending(heights)) ASSERT_EQ(std::bit_cast<std::uint64_t>(zero), 0U);
}

}  // namespace
}  // namespace fvd::metrology
