/// Points the stack must not give a height, each with its reason.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

/// A slice at a height with one pixel standing out of grey in the middle.
struct Spot {
  double z_um;
  int contrast;
};

/// Maps a stack of 3 x 3 slices; their grey and contrast are in grey levels of the format.
HeightMap map_of(const std::vector<Spot>& spots, PixelFormat format = PixelFormat::kMono8, int grey = 100,
                 PeakMethod method = PeakMethod::kParabola) {
  WorkerPool pool(1);
  FocusSettings settings{.window_px = 3, .distance_px = 1, .min_prominence = 0.5, .min_significance = 0.0};
  settings.tests.clipped_share = 0.1;  // less than a pixel of nine
  StreamingFocusStack stack(3, 3, format, settings, pool);
  for (const Spot& spot : spots) {
    if (format == PixelFormat::kMono8) {
      Plane<std::uint8_t> slice(3, 3, static_cast<std::uint8_t>(grey));
      slice.at(1, 1) = static_cast<std::uint8_t>(grey + spot.contrast);
      stack.push(image_view(slice.view(), format), spot.z_um);
    } else {
      Plane<std::uint16_t> slice(3, 3, static_cast<std::uint16_t>(grey));
      slice.at(1, 1) = static_cast<std::uint16_t>(grey + spot.contrast);
      stack.push(image_view(slice.view(), format), spot.z_um);
    }
  }
  return stack.finish(method);
}

unsigned middle(const HeightMap& map) { return map.mask.at(1, 1); }

TEST(FocusHoles, OneSliceIsBothFirstAndLast) {
  for (const PeakMethod method : kAllPeakMethods) {
    const HeightMap map = map_of({{0, 50}}, PixelFormat::kMono8, 100, method);
    EXPECT_EQ(middle(map), mask_reason::kLowProminence | mask_reason::kFirstSlice | mask_reason::kLastSlice);
    EXPECT_TRUE(std::isnan(map.height_m.at(1, 1)));
  }
}

TEST(FocusHoles, TwoSlicesBracketNothing) {
  EXPECT_EQ(middle(map_of({{0, 50}, {10, 10}})), mask_reason::kFirstSlice);
  EXPECT_EQ(middle(map_of({{0, 10}, {10, 50}})), mask_reason::kLastSlice);
  const HeightMap map = map_of({{0, 10}, {10, 50}});
  for (const MaskReasons reasons : map.mask.pixels()) EXPECT_NE(reasons, 0);
}

TEST(FocusHoles, ATripleWhoseHeightsDoNotRunOneWayIsNotBracketed) {
  EXPECT_EQ(middle(map_of({{0, 10}, {10, 90}, {5, 10}})), mask_reason::kNotBracketed);
  EXPECT_EQ(middle(map_of({{0, 10}, {10, 90}, {10, 10}})), mask_reason::kNotBracketed);
  EXPECT_EQ(middle(map_of({{20, 10}, {10, 90}, {0, 10}})), 0U) << "downwards is one way";
}

TEST(FocusHoles, HeightsOutOfOrderFarFromThePeakDoNotMatter) {
  const HeightMap map = map_of({{7, 10}, {3, 20}, {10, 90}, {21, 20}, {15, 10}});
  EXPECT_EQ(middle(map), 0U);
  EXPECT_GT(map.height_m.at(1, 1), 3e-6F);
  EXPECT_LT(map.height_m.at(1, 1), 21e-6F);
}

TEST(FocusHoles, AFlatTopOfThreeIsNotBracketed) {
  // The third value equals the peak but is not its neighbour; the triple about the first one is 90, 90 after 10.
  EXPECT_EQ(middle(map_of({{0, 10}, {10, 90}, {20, 90}, {30, 90}, {40, 10}})), 0U) << "one neighbour is lower";
  EXPECT_EQ(middle(map_of({{0, 90}, {10, 90}, {20, 10}})), mask_reason::kFirstSlice) << "the first of equals wins";
}

TEST(FocusHoles, ACurveOfZerosHasEveryReasonThatApplies) {
  EXPECT_EQ(middle(map_of({{0, 0}, {10, 0}, {20, 0}})), mask_reason::kLowProminence | mask_reason::kFirstSlice);
}

TEST(FocusHoles, ReasonsAddUp) {
  EXPECT_EQ(middle(map_of({{0, 155}, {10, 150}, {20, 145}})),
            mask_reason::kFirstSlice | mask_reason::kLowProminence | mask_reason::kSaturated);
}

TEST(FocusHoles, SaturationIsFullScaleOfTheFormat) {
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kMono10, PixelFormat::kMono12, PixelFormat::kMono16}) {
    const int top = max_grey_level(format) - 100;
    const std::string bits = std::to_string(significant_bits(format)) + " bit";
    EXPECT_EQ(middle(map_of({{0, 10}, {10, top}, {20, 10}}, format)), mask_reason::kSaturated) << bits;
    EXPECT_EQ(middle(map_of({{0, 10}, {10, top - 1}, {20, 10}}, format)), 0U) << bits;
  }
}

TEST(FocusHoles, SaturationElsewhereInTheCurveIsNoReason) {
  // The spot is at full scale in the first slice, but a flat slice of full scale has no sharpness.
  WorkerPool pool(1);
  StreamingFocusStack stack(3, 3, PixelFormat::kMono8,
                            {.window_px = 3, .distance_px = 1, .min_prominence = 0.5, .min_significance = 0.0}, pool);
  for (const int level : {-1, 10, 90, 10}) {
    Plane<std::uint8_t> slice(3, 3, level < 0 ? 255 : 100);
    if (level >= 0) slice.at(1, 1) = static_cast<std::uint8_t>(100 + level);
    stack.push(image_view(slice.view(), PixelFormat::kMono8), 10.0 * stack.slices());
  }
  EXPECT_EQ(middle(stack.finish(PeakMethod::kParabola)), 0U);
}

TEST(FocusHoles, NoiseAloneIsInsignificantWhateverItsProminence) {
  // A window of 3 x 3 sums so little that noise alone makes a prominent curve.
  std::mt19937 random(3);
  std::normal_distribution<double> normal(100.0, 3.0);
  WorkerPool pool(1);
  StreamingFocusStack stack(100, 100, PixelFormat::kMono8, {.window_px = 3, .min_prominence = 0.3}, pool);
  for (int k = 0; k < 40; ++k) {
    Plane<std::uint8_t> slice(100, 100);
    for (auto& pixel : slice.pixels()) pixel = static_cast<std::uint8_t>(std::lround(normal(random)));
    stack.push(image_view(slice.view(), PixelFormat::kMono8), 10.0 * k);
  }
  const HeightMap map = stack.finish(PeakMethod::kFiveSample);
  EXPECT_NEAR(map.noise_grey, 3.0, 0.3);
  int prominent = 0;
  int valid = 0;
  for (const MaskReasons reasons : map.mask.pixels()) {
    prominent += (reasons & mask_reason::kLowProminence) == 0 ? 1 : 0;
    valid += reasons == 0 ? 1 : 0;
  }
  EXPECT_GT(prominent, 5000) << "prominence alone would let them pass";
  EXPECT_LE(valid, 3);
}

TEST(FocusHoles, TheBlurOfABrightEdgeIsNoSurface) {
  // A bright half plane in focus at 100 um beside a dark one without texture: out of focus its light reaches across.
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.7);
  std::vector<double> texture(64 * 32);
  for (double& value : texture) value = 20.0 * noise(random);
  WorkerPool pool(1);
  StreamingFocusStack stack(64, 32, PixelFormat::kMono8, {.min_prominence = 0.3}, pool);
  for (int k = 0; k < 21; ++k) {
    const double blur = 0.04 * std::abs(10.0 * k - 100.0) + 0.3;
    Plane<std::uint8_t> slice(64, 32);
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 64; ++x) {
        const double lit = 0.5 * (1.0 + std::erf((x - 32) / (blur * std::sqrt(2.0))));
        const double grain = x >= 32 ? texture[static_cast<std::size_t>(y * 64 + x)] * std::exp(-blur) : 0.0;
        slice.at(x, y) = static_cast<std::uint8_t>(std::clamp(20.0 + 140.0 * lit + grain + noise(random), 0.0, 254.0));
      }
    }
    stack.push(image_view(slice.view(), PixelFormat::kMono8), 10.0 * k);
  }
  const HeightMap map = stack.finish(PeakMethod::kFiveSample);
  int bled = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 25; ++x) {  // a window from the edge and further
      EXPECT_NE(map.mask.at(x, y), 0) << x << ", " << y;
      bled += (map.mask.at(x, y) & mask_reason::kEdgeBleeding) != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(bled, 100);
  int kept = 0;
  for (int x = 40; x < 60; ++x) kept += map.mask.at(x, 16) == 0 ? 1 : 0;
  EXPECT_GE(kept, 18) << "the bright surface itself";
}

TEST(FocusHoles, AHeightNoStageCanHaveIsRefusedAndLeavesTheStackAsItWas) {
  WorkerPool pool(1);
  StreamingFocusStack stack(3, 3, PixelFormat::kMono8,
                            {.window_px = 3, .distance_px = 1, .min_prominence = 0.5, .min_significance = 0.0}, pool);
  const Plane<std::uint8_t> slice(3, 3, 7);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double z_um : {std::nan(""), kInfinity, -kInfinity, 1.1e9, -1e300}) {
    try {
      stack.push(image_view(slice.view(), PixelFormat::kMono8), z_um);
      ADD_FAILURE() << z_um << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadSlice);
      EXPECT_NE(std::string(error.what()).find("slice 0 has a z of"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(stack.slices(), 0);
  stack.push(image_view(slice.view(), PixelFormat::kMono8), -StreamingFocusStack::kMaxHeight_um);
  EXPECT_EQ(stack.slices(), 1);
}

}  // namespace
}  // namespace fvd
