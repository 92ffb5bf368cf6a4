/// The streaming stack against its twin that keeps everything.

#include "core/focus/simple_focus_stack.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "gtest/gtest.h"
#include "tests/core/focus/synthetic_scan.hpp"

namespace fvd {
namespace {

void expect_identical(const HeightMap& a, const HeightMap& b) {
  ASSERT_EQ(a.height_m.pixels().size(), b.height_m.pixels().size());
  EXPECT_EQ(std::memcmp(a.height_m.pixels().data(), b.height_m.pixels().data(), a.height_m.pixels().size_bytes()), 0);
  EXPECT_EQ(std::memcmp(a.sigma_m.pixels().data(), b.sigma_m.pixels().data(), a.sigma_m.pixels().size_bytes()), 0);
  EXPECT_EQ(a.noise_grey, b.noise_grey);
  EXPECT_EQ(a.curve_width_um, b.curve_width_um);
  EXPECT_EQ(a.stage.offsets_um, b.stage.offsets_um);
  EXPECT_EQ(a.stage.rms_um, b.stage.rms_um);
  EXPECT_TRUE(std::ranges::equal(a.mask.pixels(), b.mask.pixels()));
  EXPECT_TRUE(std::ranges::equal(a.prominence.pixels(), b.prominence.pixels()));
  EXPECT_TRUE(std::ranges::equal(a.texture.pixels(), b.texture.pixels()));
  EXPECT_EQ(a.texture_format, b.texture_format);
}

struct Case {
  PixelFormat format;
  Surface surface;
  int width;
  int height;
  int slices;
  int window;
  int distance = 1;
  FocusOperator focus_operator = FocusOperator::kModifiedLaplacian;
  int bin = 1;
  double second_peak = 0.0;
};

class AStreamingStack : public testing::TestWithParam<Case> {};

TEST_P(AStreamingStack, EqualsTheOneThatKeepsEverything) {
  const Case c = GetParam();
  const Scan scan = make_scan(c.format, c.surface, c.width, c.height, c.slices, 7);
  FocusSettings settings{.focus_operator = c.focus_operator,
                         .window_px = c.window,
                         .distance_px = c.distance,
                         .min_prominence = 0.3,
                         .min_significance = 2.0,
                         .bin_slices = c.bin};
  settings.tests.second_peak = c.second_peak;
  SimpleFocusStack simple(settings);
  for (std::size_t k = 0; k < scan.slices.size(); ++k) simple.push(scan.slice(k), scan.z_um[k]);
  for (const PeakMethod method : kAllPeakMethods) {
    const HeightMap expected = simple.finish(method);
    for (const int threads : {1, 2, 5}) {
      for (const std::size_t batch : {std::size_t{1}, std::size_t{3}, std::size_t{20}}) {
        SCOPED_TRACE(std::string(peak_method_name(method)) + ", threads " + std::to_string(threads) + ", batch " +
                     std::to_string(batch));
        expect_identical(stream(scan, settings, method, threads, batch), expected);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    OnEverySurface, AStreamingStack,
    testing::Values(
        Case{PixelFormat::kMono8, Surface::kTilted, 53, 31, 15, 9},
        Case{PixelFormat::kMono8, Surface::kStepped, 64, 17, 12, 5, 3},
        Case{PixelFormat::kMono8, Surface::kRandom, 40, 23, 9, 3},
        Case{PixelFormat::kMono16, Surface::kTilted, 37, 29, 15, 7, 2},
        Case{PixelFormat::kMono16, Surface::kRandom, 33, 11, 21, 31},
        Case{PixelFormat::kMono12, Surface::kStepped, 20, 20, 8, 9},
        Case{PixelFormat::kMono8, Surface::kTilted, 1, 1, 5, 9},
        Case{PixelFormat::kMono8, Surface::kTilted, 3, 2, 5, 63, 7},
        Case{PixelFormat::kMono8, Surface::kTilted, 40, 30, 31, 9, 2, FocusOperator::kTenengrad},
        Case{PixelFormat::kMono12, Surface::kStepped, 30, 30, 15, 7, 1, FocusOperator::kTenengrad, 2},
        Case{PixelFormat::kMono16, Surface::kTilted, 30, 20, 15, 1, 1, FocusOperator::kIntensity},
        Case{PixelFormat::kMono8, Surface::kTilted, 53, 31, 30, 9, 2, FocusOperator::kModifiedLaplacian, 3},
        Case{PixelFormat::kMono16, Surface::kTilted, 33, 21, 29, 5, 1, FocusOperator::kModifiedLaplacian, 4},
        Case{PixelFormat::kMono8, Surface::kRandom, 33, 21, 3, 5, 1, FocusOperator::kModifiedLaplacian, 4},
        Case{PixelFormat::kMono8, Surface::kBright, 45, 33, 15, 9, 2},
        Case{PixelFormat::kMono12, Surface::kBright, 45, 21, 29, 5, 1, FocusOperator::kDiagonalLaplacian, 3},
        Case{PixelFormat::kMono8, Surface::kRandom, 49, 23, 25, 3, 1, FocusOperator::kModifiedLaplacian, 1, 0.6},
        Case{PixelFormat::kMono16, Surface::kRandom, 35, 20, 30, 3, 1, FocusOperator::kDiagonalLaplacian, 1, 0.8},
        Case{PixelFormat::kMono8, Surface::kRandom, 21, 20, 31, 3, 1, FocusOperator::kTenengrad, 3, 0.5},
        Case{PixelFormat::kMono12, Surface::kTilted, 53, 31, 25, 3, 1, FocusOperator::kIntensity, 1, 0.5},
        Case{PixelFormat::kMono8, Surface::kRandom, 8, 8, 1, 3, 1, FocusOperator::kModifiedLaplacian, 1, 0.8},
        Case{PixelFormat::kMono8, Surface::kTilted, 8, 8, 1, 3},
        Case{PixelFormat::kMono8, Surface::kTilted, 8, 8, 2, 3}));

/// Large enough for its pages to be kept; rows end within a vector of columns.
TEST(AStackOnKeptPages, KnowsNothingOfTheScanBefore) {
  constexpr int kWidth = 331;
  constexpr int kHeight = 350;
  WorkerPool pool(2);
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kMono16}) {
    const Scan before = make_scan(format, Surface::kBright, kWidth, kHeight, 7, 1);
    const Scan scan = make_scan(format, Surface::kStepped, kWidth, kHeight, 13, 2);
    for (const int bin : {1, 2}) {
      FocusSettings settings{.min_prominence = 0.3, .bin_slices = bin};
      settings.tests.second_peak = 0.8;
      const auto map_of = [&](const Scan& slices, const KeptPagesPtr& pages) {
        StreamingFocusStack stack(kWidth, kHeight, format, settings, pool, false, pages);
        for (std::size_t k = 0; k < slices.slices.size(); ++k) stack.push(slices.slice(k), slices.z_um[k]);
        return stack.finish(PeakMethod::kFiveSample);
      };
      const auto pages = std::make_shared<KeptPages>(std::size_t{256} << 20U);
      (void)map_of(before, pages);
      ASSERT_GT(pages->kept_bytes(), 0U);
      const HeightMap map = map_of(scan, pages);
      expect_identical(map, map_of(scan, nullptr));
      EXPECT_GT(std::ranges::count(map.mask.pixels(), MaskReasons{0}), kWidth * kHeight / 2);
    }
  }
}

}  // namespace
}  // namespace fvd
