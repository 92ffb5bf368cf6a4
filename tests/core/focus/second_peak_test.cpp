/// Points whose focus curve has two peaks: two textures at two heights in one window.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

constexpr int kSide = 128;
constexpr double kLimit = 0.8;

/// A semi-transparent layer over a plane. All lengths in widths of the focus curve.
struct Layers {
  double share;       ///< of the layer's contrast; the rest is the plane's
  double apart;       ///< the layer above the plane
  double step;        ///< from slice to slice
  double tilt = 0.0;  ///< rise of the layer and the plane over the image
  double before = 3.0;
  double after = 3.0;  ///< of the scan, beyond the highest surface
  double noise_grey = 1.5;
  double contrast_grey = 25.0;
};

double contrast(double widths) {
  const double root = 1.0 + 4.0 * (std::sqrt(2.0) - 1.0) * widths * widths;
  return 1.0 / (root * root);
}

HeightMap map_of(const Layers& scene, const FocusSettings& settings, PeakMethod method = PeakMethod::kFiveSample) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> upper(static_cast<std::size_t>(kSide) * kSide);
  std::vector<double> lower(upper.size());
  for (double& grain : upper) grain = normal(random);
  for (double& grain : lower) grain = normal(random);
  WorkerPool pool(2);
  StreamingFocusStack stack(kSide, kSide, PixelFormat::kMono8, settings, pool);
  const int slices = static_cast<int>((scene.before + scene.apart + scene.tilt + scene.after) / scene.step) + 1;
  for (int k = 0; k < slices; ++k) {
    Plane<std::uint8_t> slice(kSide, kSide);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const auto i = static_cast<std::size_t>(y * kSide + x);
        const double z = scene.step * k - scene.before - scene.tilt * x / kSide;
        const double grey = 110.0 +
                            scene.contrast_grey * ((1.0 - scene.share) * lower[i] * contrast(z) +
                                                   scene.share * upper[i] * contrast(z - scene.apart)) +
                            scene.noise_grey * normal(random);
        slice.at(x, y) = static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
      }
    }
    stack.push(image_view(slice.view(), PixelFormat::kMono8), 10.0 * scene.step * k);
  }
  return stack.finish(method);
}

FocusSettings with_test() {
  FocusSettings settings;
  settings.tests.second_peak = kLimit;
  return settings;
}

double share_with(const HeightMap& map, MaskReasons reason) {
  int found = 0;
  for (const MaskReasons mask : map.mask.pixels()) found += (mask & reason) != 0 ? 1 : 0;
  return static_cast<double>(found) / (kSide * kSide);
}

double share_valid(const HeightMap& map) {
  int valid = 0;
  for (const MaskReasons mask : map.mask.pixels()) valid += mask == 0 ? 1 : 0;
  return static_cast<double>(valid) / (kSide * kSide);
}

TEST(SecondPeak, TwoLayersOfLikeContrastAreHoles) {
  for (const double apart : {2.0, 3.0, 4.5}) {
    for (const double step : {0.1, 0.25, 0.4}) {
      const Layers half{0.5, apart, step};
      const auto scene = testing::Message() << apart << " apart, step " << step;
      const double found = share_with(map_of(half, with_test()), mask_reason::kSecondPeak);
      EXPECT_GE(found, 0.7) << scene;
      EXPECT_EQ(share_with(map_of(half, {}), mask_reason::kSecondPeak), 0.0) << scene << ", not asked for";
      EXPECT_LE(share_with(map_of({0.1, apart, step}, with_test()), mask_reason::kSecondPeak), 0.001) << scene;
      EXPECT_LE(share_with(map_of({0.9, apart, step}, with_test()), mask_reason::kSecondPeak), 0.001) << scene;
    }
  }
}

TEST(SecondPeak, LiesAtLeastFourSlicesAway) {
  EXPECT_GE(share_with(map_of({0.5, 4.5, 0.8}, with_test()), mask_reason::kSecondPeak), 0.5);
  EXPECT_EQ(share_with(map_of({0.5, 2.0, 0.8}, with_test()), mask_reason::kSecondPeak), 0.0);
}

TEST(SecondPeak, IsFoundByEveryPeakMethodAndInBins) {
  const Layers half{0.5, 3.0, 0.4};
  const double found = share_with(map_of(half, with_test()), mask_reason::kSecondPeak);
  EXPECT_EQ(share_with(map_of(half, with_test(), PeakMethod::kParabola), mask_reason::kSecondPeak), found);
  FocusSettings bins = with_test();
  bins.bin_slices = 3;
  EXPECT_GE(share_with(map_of({0.5, 3.0, 0.1}, bins), mask_reason::kSecondPeak), 0.6);
}

TEST(SecondPeak, ASinglePlaneHasNone) {
  for (const double step : {0.05, 0.1, 0.25, 0.4, 1.0}) {
    for (const double contrast_grey : {25.0, 8.0, 4.0}) {
      const Layers plane{.share = 0.0,
                         .apart = 0.0,
                         .step = step,
                         .tilt = 1.0,
                         .before = std::max(3.0, 4.0 * step),
                         .after = std::max(3.0, 4.0 * step),
                         .contrast_grey = contrast_grey};
      const HeightMap map = map_of(plane, with_test());
      EXPECT_LE(share_with(map, mask_reason::kSecondPeak), 0.001) << step << ", contrast " << contrast_grey;
      if (contrast_grey > 20.0) {
        EXPECT_GE(share_valid(map), 0.9) << step;
      }
    }
  }
}

TEST(SecondPeak, AScanThatBeginsOrEndsOnAFlankHasNone) {
  for (const bool begins : {false, true}) {
    const Layers plane{.share = 0.0,
                       .apart = 0.0,
                       .step = 0.1,
                       .tilt = 0.3,
                       .before = begins ? 0.5 : 3.0,
                       .after = begins ? 3.0 : 0.5};
    EXPECT_LE(share_with(map_of(plane, with_test()), mask_reason::kSecondPeak), 0.001) << begins;
  }
}

TEST(SecondPeak, PointsThatHaveOneBecomeHolesAndKeepTheirOtherReasons) {
  const Layers half{0.5, 3.0, 0.4, 0.5};
  FocusSettings off;
  off.tests = {.broad_curve = 0.0, .narrow_curve = 0.0, .edge_band_slices = 0};  // which ask the other points
  off.stage_correction = false;
  FocusSettings on = off;
  on.tests.second_peak = kLimit;
  const HeightMap without = map_of(half, off);
  const HeightMap with = map_of(half, on);
  int new_holes = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const MaskReasons mask = with.mask.at(x, y);
      ASSERT_EQ(mask & ~unsigned{mask_reason::kSecondPeak}, without.mask.at(x, y)) << x << ", " << y;
      ASSERT_EQ(std::isnan(with.height_m.at(x, y)), mask != 0);
      ASSERT_EQ(std::isnan(with.sigma_m.at(x, y)), mask != 0);
      new_holes += mask == mask_reason::kSecondPeak ? 1 : 0;
    }
  }
  EXPECT_GT(new_holes, kSide * kSide / 2);
}

}  // namespace
}  // namespace fvd
