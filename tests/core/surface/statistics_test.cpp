#include "core/surface/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/units.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd {
namespace {

constexpr double kFloatUm = 1e-5;  // what float32 metres can tell apart at these heights

/// height[y][x] = x + 10 y um, all points valid with a standard error of 0.2 um.
struct Surface {
  Surface(int width, int height)
      : height_m(width, height), sigma_m(width, height, 0.2e-6F), mask(width, height, MaskReasons{0}) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) height_m.at(x, y) = static_cast<float>((x + 10 * y) * kMetresPerMicrometer);
    }
  }

  void make_hole(int x, int y, unsigned reasons) {
    mask.at(x, y) = static_cast<MaskReasons>(reasons);
    height_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    sigma_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
  }

  [[nodiscard]] HeightSummary summary() const { return summarize_heights(height_m, sigma_m, mask); }

  Plane<float> height_m;
  Plane<float> sigma_m;
  Plane<MaskReasons> mask;
};

TEST(HeightSummary, DescribesTheValidPoints) {
  Surface surface(5, 1);  // 0 1 2 3 4 um
  surface.make_hole(0, 0, mask_reason::kLowProminence);
  const HeightSummary summary = surface.summary();
  EXPECT_EQ(summary.points, 5U);
  EXPECT_EQ(summary.valid, 4U);
  EXPECT_DOUBLE_EQ(summary.valid_fraction(), 0.8);
  ASSERT_TRUE(summary.height);
  EXPECT_NEAR(summary.height->min_um, 1.0, kFloatUm);
  EXPECT_NEAR(summary.height->max_um, 4.0, kFloatUm);
  EXPECT_NEAR(summary.height->mean_um, 2.5, kFloatUm);
  EXPECT_NEAR(summary.height->median_um, 2.5, kFloatUm) << "the mean of the two middle ones";
  ASSERT_TRUE(summary.sigma_median_um);
  EXPECT_NEAR(*summary.sigma_median_um, 0.2, kFloatUm);
}

TEST(HeightSummary, TakesTheMiddleOneOfAnOddNumber) {
  EXPECT_NEAR(Surface(5, 1).summary().height->median_um, 2.0, kFloatUm);
}

TEST(HeightSummary, CountsAPointWithTwoReasonsTwice) {
  Surface surface(6, 3);
  surface.make_hole(0, 0, mask_reason::kFirstSlice | mask_reason::kSaturated);
  surface.make_hole(1, 0, mask_reason::kLastSlice);
  surface.make_hole(2, 0, mask_reason::kNotBracketed);
  surface.make_hole(3, 0, mask_reason::kLowProminence);
  surface.make_hole(4, 0, mask_reason::kInsignificant | mask_reason::kEdgeBleeding);
  surface.make_hole(5, 0, mask_reason::kBroadCurve | mask_reason::kNarrowCurve);
  surface.make_hole(0, 1, mask_reason::kSecondPeak | mask_reason::kEdgeBand);
  surface.make_hole(1, 1, mask_reason::kMaxSigma);
  const HeightSummary summary = surface.summary();
  EXPECT_EQ(summary.holes.first_slice, 1U);
  EXPECT_EQ(summary.holes.saturated, 1U);
  EXPECT_EQ(summary.holes.last_slice, 1U);
  EXPECT_EQ(summary.holes.not_bracketed, 1U);
  EXPECT_EQ(summary.holes.low_prominence, 1U);
  EXPECT_EQ(summary.holes.insignificant, 1U);
  EXPECT_EQ(summary.holes.edge_bleeding, 1U);
  EXPECT_EQ(summary.holes.broad_curve, 1U);
  EXPECT_EQ(summary.holes.narrow_curve, 1U);
  EXPECT_EQ(summary.holes.second_peak, 1U);
  EXPECT_EQ(summary.holes.edge_band, 1U);
  EXPECT_EQ(summary.holes.max_sigma, 1U);
  EXPECT_EQ(summary.valid, 10U);
}

TEST(HeightSummary, IsWhatSortingTells) {
  std::mt19937 random(5);
  for (const int points : {1, 2, 7, 1000, 4999, 5000}) {
    Surface surface(points, 1);
    std::vector<float> heights;
    std::vector<float> errors;
    double sum_m = 0.0;
    for (int i = 0; i < points; ++i) {
      const bool many_equal = i % 3 == 0;
      surface.height_m.at(i, 0) = many_equal ? -1e-6F : (static_cast<float>(random() % 20001) - 10000.0F) * 1e-9F;
      surface.sigma_m.at(i, 0) = static_cast<float>(random() % 1000) * 1e-9F;
      if (points > 2 && i % 11 == 0) surface.make_hole(i, 0, mask_reason::kSaturated);
      if (std::isnan(surface.height_m.at(i, 0))) continue;
      heights.push_back(surface.height_m.at(i, 0));
      errors.push_back(surface.sigma_m.at(i, 0));
      sum_m += static_cast<double>(heights.back());
    }
    std::sort(heights.begin(), heights.end());
    std::sort(errors.begin(), errors.end());
    const auto um = [](float metres) { return static_cast<double>(metres) / kMetresPerMicrometer; };
    const auto median_um = [um](const std::vector<float>& of) {
      return (um(of[(of.size() - 1) / 2]) + um(of[of.size() / 2])) / 2;
    };
    const auto at = [&](double share) {
      return um(heights[static_cast<std::size_t>(std::lround(share * static_cast<double>(heights.size() - 1)))]);
    };

    const HeightSummary summary = surface.summary();

    ASSERT_TRUE(summary.height);
    EXPECT_EQ(summary.valid, heights.size());
    EXPECT_EQ(summary.height->min_um, um(heights.front()));
    EXPECT_EQ(summary.height->max_um, um(heights.back()));
    EXPECT_EQ(summary.height->median_um, median_um(heights));
    EXPECT_EQ(summary.height->low_um, at(0.005));
    EXPECT_EQ(summary.height->high_um, at(0.995));
    EXPECT_EQ(summary.sigma_median_um, median_um(errors));
    const double mean_um = sum_m / static_cast<double>(heights.size()) / kMetresPerMicrometer;
    EXPECT_NEAR(summary.height->mean_um, mean_um, 1e-12 * std::abs(mean_um));
  }
}

TEST(HeightSummary, HasNoHeightsWhereAllPointsAreHoles) {
  Surface surface(1, 1);
  surface.make_hole(0, 0, mask_reason::kLowProminence);
  const HeightSummary summary = surface.summary();
  EXPECT_FALSE(summary.height);
  EXPECT_FALSE(summary.sigma_median_um);
  EXPECT_EQ(summary.valid_fraction(), 0.0);
}

TEST(HeightSummary, IsEmptyForASurfaceWithoutPoints) {
  const HeightSummary summary = Surface(0, 0).summary();
  EXPECT_EQ(summary.points, 0U);
  EXPECT_FALSE(summary.height);
  EXPECT_EQ(summary.valid_fraction(), 0.0);
}

TEST(HeightSummary, KeepsOutliersOutOfTheRobustLimits) {
  Surface surface(100, 20);
  for (float& z : surface.height_m.pixels()) z = 5e-6F;
  surface.height_m.at(0, 0) = -1.0F;
  surface.height_m.at(1, 0) = 1.0F;
  const auto height = surface.summary().height;
  EXPECT_NEAR(height->low_um, 5.0, kFloatUm);
  EXPECT_NEAR(height->high_um, 5.0, kFloatUm);
  EXPECT_NEAR(height->max_um, 1e6, 1e-3);
}

}  // namespace
}  // namespace fvd
