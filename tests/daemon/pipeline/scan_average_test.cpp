#include "daemon/pipeline/scan_average.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/surface/mask_reason.hpp"

namespace fvd {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

HeightMap map_of(const std::vector<float>& heights_m, float sigma_m) {
  HeightMap map = empty_map(static_cast<int>(heights_m.size()), 1, PixelFormat::kMono8);
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    map.height_m.pixels()[i] = heights_m[i];
    map.sigma_m.pixels()[i] = std::isnan(heights_m[i]) ? kHole : sigma_m;
    map.mask.pixels()[i] = std::isnan(heights_m[i]) ? MaskReasons{1} : MaskReasons{0};
    map.prominence.pixels()[i] = 0.5F;
    map.texture.pixels()[i] = 7;
  }
  return map;
}

TEST(ScanAverage, GivesMeanScatterAndStandardErrorOfKnownScans) {
  // z = 1, 2, 6 um: mean 3, deviations -2, -1, 3: s = sqrt(14 / 2). Standard errors 0.3, 0.4, 1.2: sqrt(1.69) / 3.
  ScanAverage average(2, 1);
  average.add(map_of({1e-6F, -5e-6F}, 0.3e-6F));
  average.add(map_of({2e-6F, -5e-6F}, 0.4e-6F));
  HeightMap map = map_of({6e-6F, -5e-6F}, 1.2e-6F);
  average.add(map);

  const RepeatedScans repeated = average.finish(map);

  EXPECT_EQ(repeated.scans, 3);
  EXPECT_NEAR(map.height_m.pixels()[0], 3e-6, 1e-12);
  EXPECT_NEAR(map.height_m.pixels()[1], -5e-6, 1e-12);
  EXPECT_NEAR(map.sigma_m.pixels()[0], 1.3e-6 / 3.0, 1e-12);
  EXPECT_NEAR(repeated.sd_m.pixels()[0], std::sqrt(7.0) * 1e-6, 1e-12);
  EXPECT_NEAR(repeated.sd_m.pixels()[1], 0.0, 1e-12);
  ASSERT_TRUE(repeated.sd_rms_um.has_value());
  EXPECT_NEAR(*repeated.sd_rms_um, std::sqrt(3.5), 1e-6);
  EXPECT_EQ(map.texture.pixels()[0], 7) << "what is no height stays the last scan's";
}

TEST(ScanAverage, KeepsAPointOnlyWhereEveryScanHasIt) {
  ScanAverage average(4, 1);
  HeightMap first = map_of({kHole, 1e-6F, kHole, 1e-6F}, 1e-7F);
  first.mask.pixels()[0] = 0x10;
  first.mask.pixels()[2] = 0x02;
  average.add(first);
  HeightMap map = map_of({1e-6F, kHole, kHole, 3e-6F}, 1e-7F);
  map.mask.pixels()[1] = 0x04;
  map.mask.pixels()[2] = 0x08;
  average.add(map);

  const RepeatedScans repeated = average.finish(map);

  EXPECT_EQ(map.mask.pixels()[0], 0x10);
  EXPECT_EQ(map.mask.pixels()[1], 0x04);
  EXPECT_EQ(map.mask.pixels()[2], 0x0A) << "the reasons of both";
  EXPECT_EQ(map.mask.pixels()[3], 0);
  for (const std::size_t hole : {0U, 1U, 2U}) {
    EXPECT_TRUE(std::isnan(map.height_m.pixels()[hole])) << hole;
    EXPECT_TRUE(std::isnan(map.sigma_m.pixels()[hole])) << hole;
    EXPECT_TRUE(std::isnan(repeated.sd_m.pixels()[hole])) << hole;
  }
  EXPECT_NEAR(map.height_m.pixels()[3], 2e-6, 1e-12);
  EXPECT_NEAR(repeated.sd_rms_um.value(), std::sqrt(2.0), 1e-6) << "of the valid point alone";
}

TEST(ScanAverage, TellsNoScatterWithoutAValidPoint) {
  ScanAverage average(1, 1);
  HeightMap map = map_of({kHole}, 1e-7F);
  average.add(map);
  average.add(map);

  EXPECT_FALSE(average.finish(map).sd_rms_um.has_value());
}

TEST(ScanAverage, WarnsWhereTheScansScatterByMoreThanTheyTell) {
  // Two scans that differ by d: s = d / sqrt 2. The hole does not count.
  const auto warning_of = [](double d_um) {
    ScanAverage average(2, 1);
    average.add(map_of({0.0F, kHole}, 0.3e-6F));
    HeightMap map = map_of({static_cast<float>(1e-6 * d_um), 1e-6F}, 0.4e-6F);
    average.add(map);
    const RepeatedScans repeated = average.finish(map);
    return scatter_warning(repeated, map);
  };
  const double expected_um = std::sqrt((0.09 + 0.16) / 2.0);

  EXPECT_FALSE(warning_of(2.9 * expected_um * std::sqrt(2.0)).has_value());
  const auto warning = warning_of(3.1 * expected_um * std::sqrt(2.0));
  ASSERT_TRUE(warning.has_value());
  EXPECT_EQ(warning->code, "repeat_scatter");
  EXPECT_NE(warning->text.find("0.354"), std::string::npos) << warning->text;
  EXPECT_FALSE(scatter_warning({2, {}, std::nullopt}, map_of({kHole}, 0.0F)).has_value()) << "no point tells";
}

TEST(ScanAverage, LosesNoDigitsFarFromZero) {
  // Scatter of 10 nm at a height of 100 mm, where a float has steps of 7 nm: the sums may not add their own rounding.
  ScanAverage average(1, 1);
  std::vector<float> heights_m;
  std::mt19937 random(20);  // fixed
  std::normal_distribution<double> noise(0.0, 1e-8);
  for (int scan = 0; scan < 20; ++scan) heights_m.push_back(static_cast<float>(0.1 + noise(random)));
  HeightMap map;
  for (const float height_m : heights_m) {
    map = map_of({height_m}, 1e-8F);
    average.add(map);
  }
  long double mean = 0.0L;
  for (const float height_m : heights_m) mean += static_cast<long double>(height_m) / 20.0L;
  long double squares = 0.0L;
  for (const float height_m : heights_m) {
    squares += (static_cast<long double>(height_m) - mean) * (static_cast<long double>(height_m) - mean);
  }

  const RepeatedScans repeated = average.finish(map);

  EXPECT_NEAR(repeated.sd_m.pixels()[0], static_cast<double>(std::sqrt(squares / 19.0L)), 1e-12);
  EXPECT_NEAR(map.sigma_m.pixels()[0], 1e-8 / std::sqrt(20.0), 1e-13);
}

}  // namespace
}  // namespace fvd
