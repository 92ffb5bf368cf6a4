/// Points with a peak that is no surface: their curves are broader or narrower than the scan's, or they are too
/// uncertain.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

constexpr int kSide = 160;
constexpr int kSlices = 21;
constexpr double kStep_um = 10.0;

/// Grey level of a pixel in slice k, without noise. grain: of the texture at that pixel, standard deviation 1.
using Level = std::function<double(int x, int y, int k, double grain)>;

HeightMap map_of(const Level& level, const FocusSettings& settings = {}, PeakMethod method = PeakMethod::kFiveSample,
                 int threads = 1, int missing = -1) {
  std::mt19937 random(21);
  std::normal_distribution<double> normal;
  std::vector<double> grain(static_cast<std::size_t>(kSide) * kSide);
  for (double& value : grain) value = normal(random);
  WorkerPool pool(threads);
  StreamingFocusStack stack(kSide, kSide, PixelFormat::kMono8, settings, pool);
  for (int k = 0; k < kSlices; ++k) {
    if (k == missing) continue;
    Plane<std::uint8_t> slice(kSide, kSide);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const double grey = level(x, y, k, grain[static_cast<std::size_t>(y * kSide + x)]) + 1.5 * normal(random);
        slice.at(x, y) = static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
      }
    }
    stack.push(image_view(slice.view(), PixelFormat::kMono8), kStep_um * k);
  }
  return stack.finish(method);
}

/// Contrast of texture k slices' distance from the surface, its curve `width` samples wide at half height.
double contrast(double slices, double width) {
  const double root = 1.0 + 4.0 * (std::sqrt(2.0) - 1.0) * slices * slices / (width * width);
  return 1.0 / (root * root);
}

double share_kept(const HeightMap& map, int first_column, int end_column, MaskReasons besides = 0) {
  int kept = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = first_column; x < end_column; ++x) kept += (map.mask.at(x, y) & ~besides) == 0 ? 1 : 0;
  }
  return static_cast<double>(kept) / (kSide * (end_column - first_column));
}

/// 60 pixels that each light up in one slice.
class Blinking {
 public:
  Blinking() : slice_(static_cast<std::size_t>(kSide) * kSide, -1) {
    std::mt19937 random(9);
    for (int i = 0; i < 60; ++i) slice_[random() % slice_.size()] = static_cast<int>(random() % kSlices);
  }
  [[nodiscard]] double at(int x, int y, int k) const {
    return slice_[static_cast<std::size_t>(y * kSide + x)] == k ? 60.0 : 0.0;
  }

 private:
  std::vector<int> slice_;
};

double tilted_slices(int x, double k) { return k - 6.0 - 8.0 * x / kSide; }

/// Of the kept points of a tilted surface, those off by more than a slice.
double share_wrong(const HeightMap& map) {
  int kept = 0;
  int wrong = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (map.mask.at(x, y) != 0) continue;
      ++kept;
      wrong +=
          std::abs(static_cast<double>(map.height_m.at(x, y)) * 1e6 / kStep_um + tilted_slices(x, 0.0)) > 1.0 ? 1 : 0;
    }
  }
  return static_cast<double>(wrong) / kept;
}

TEST(PointTests, ABlinkingPixelIsNoSurfaceBesideTexture) {
  const Blinking blinking;
  const Level level = [&](int x, int y, int k, double grain) {
    const double texture = x < kSide / 2 ? 25.0 * grain * contrast(tilted_slices(x, k), 3.0) : 0.0;
    return 100.0 + texture + blinking.at(x, y, k);
  };
  for (const PeakMethod method : {PeakMethod::kFiveSample, PeakMethod::kParabola}) {
    FocusSettings settings;
    const HeightMap map = map_of(level, settings, method);
    EXPECT_LE(share_kept(map, kSide / 2 + 12, kSide), 0.001);
    EXPECT_GE(share_kept(map, 0, kSide / 2 - 12), 0.98) << "the texture, in which pixels blink as well";
    settings.tests.narrow_curve = 0.0;
    EXPECT_GE(share_kept(map_of(level, settings, method), kSide / 2 + 12, kSide), 0.03) << "the test turned off";
  }
}

TEST(PointTests, PixelsThatBlinkOneAfterTheOtherAreNoSurface) {
  const Level level = [&](int x, int y, int k, double grain) {
    const double texture = x < kSide / 2 ? 25.0 * grain * contrast(tilted_slices(x, k), 3.0) : 0.0;
    const int place = y / 20 + 8 * (x / 20);  // of pairs 3 px apart in a slice and the next, also near the scan's ends
    const bool first = x % 20 == 8 && y % 20 == 10 && k == 1 + place % (kSlices - 3);
    const bool second = x % 20 == 11 && y % 20 == 10 && k == 2 + place % (kSlices - 3);
    return 100.0 + texture + (first || second ? 60.0 : 0.0);
  };
  for (const PeakMethod method : {PeakMethod::kFiveSample, PeakMethod::kParabola}) {
    const HeightMap map = map_of(level, {}, method);
    EXPECT_LE(share_kept(map, kSide / 2 + 12, kSide), 0.01);
    EXPECT_GE(share_kept(map, 0, kSide / 2 - 12), 0.98);
  }
}

TEST(PointTests, BlinkingPixelsAreNoSurfaceWhereNothingElseHasAPeak) {
  const Blinking blinking;
  const Level level = [&](int x, int y, int k, double) { return 100.0 + blinking.at(x, y, k); };
  EXPECT_LE(share_kept(map_of(level), 0, kSide), 0.001);
  FocusSettings off;
  off.tests.narrow_curve = 0.0;
  EXPECT_GE(share_kept(map_of(level, off), 0, kSide), 0.03);
}

TEST(PointTests, AScanInStepsOfAWholeWidthKeepsItsPoints) {
  const HeightMap map =
      map_of([](int x, int, int k, double grain) { return 100.0 + 25.0 * grain * contrast(tilted_slices(x, k), 1.0); });
  EXPECT_GE(share_kept(map, 0, kSide), 0.995);
}

TEST(PointTests, PointsBesideAMissingSliceAreKept) {
  const Level level = [](int x, int, int k, double grain) {
    return 100.0 + 25.0 * grain * contrast(tilted_slices(x, k), 3.0);
  };
  for (const PeakMethod method : {PeakMethod::kFiveSample, PeakMethod::kParabola}) {
    EXPECT_GE(share_kept(map_of(level, {}, method, 1, 10), 0, kSide), 0.98);
  }
}

TEST(PointTests, ACurveFarBroaderThanTheScansIsABlurFromElsewhere) {
  const Level level = [](int x, int, int k, double grain) {
    const double width = x < kSide / 2 ? 3.0 : 9.0;
    return 100.0 + 25.0 * grain * contrast(k - 10.3, width);
  };
  // The narrow curves are the median only if there are more of them.
  const Level mostly_narrow = [&](int x, int y, int k, double grain) { return level(x < 100 ? 0 : x, y, k, grain); };
  for (const PeakMethod method : {PeakMethod::kFiveSample, PeakMethod::kInverseRoot}) {
    FocusSettings settings;
    const HeightMap map = map_of(mostly_narrow, settings, method);
    EXPECT_GE(share_kept(map, 0, 90), 0.995);
    EXPECT_LE(share_kept(map, 110, kSide), 0.02);
    EXPECT_GE(share_kept(map, 110, kSide, mask_reason::kBroadCurve), 0.98) << "no other reason";
    settings.tests.broad_curve = 0.0;
    EXPECT_GE(share_kept(map_of(mostly_narrow, settings, method), 110, kSide), 0.98) << "the test turned off";
  }
}

/// Glints of 0.5 px^2 and `level` times full scale on a tilted plane, blurred with 0.04 px per um, 8 um from slice to
/// slice.
class Glints {
 public:
  explicit Glints(double level) : energy_(0.5 * 255.0 * level) {
    std::mt19937 random(5);
    for (int i = 0; i < 64; ++i) {  // 1500 on 0.6 Mpx
      places_.emplace_back(static_cast<int>(random() % kSide), static_cast<int>(random() % kSide));
    }
  }
  [[nodiscard]] double at(int x, int y, double slices) const {
    const double variance = 0.6 + 0.0016 * 64.0 * slices * slices;
    double sum = 0.0;
    for (const auto& [u, v] : places_) {
      const double square = (x - u) * (x - u) + (y - v) * (y - v);
      if (square < 40.0 * variance) sum += std::exp(-square / (2.0 * variance));
    }
    return energy_ * sum / (2.0 * 3.14159265358979 * variance);
  }

 private:
  double energy_;
  std::vector<std::pair<int, int>> places_;
};

TEST(PointTests, AGlintCostsOnlyWhatItSpoils) {
  struct Bounds {
    double level;
    double kept;
    double wrong;
  };
  for (const Bounds& bounds : {Bounds{10.0, 0.95, 0.0}, Bounds{40.0, 0.90, 0.002}, Bounds{200.0, 0.60, 0.003}}) {
    const Glints glints(bounds.level);
    const Level level = [&](int x, int y, int k, double grain) {
      const double slices = tilted_slices(x, k);
      return std::min(100.0 + 18.0 * grain * contrast(slices, 5.0) + glints.at(x, y, slices), 255.0);
    };
    FocusSettings settings;
    const HeightMap map = map_of(level, settings);
    settings.tests.clipped_share = 0.01;  // no pixel
    const HeightMap none = map_of(level, settings);
    EXPECT_GE(share_kept(map, 0, kSide), bounds.kept) << bounds.level;
    EXPECT_LE(share_kept(none, 0, kSide), 0.85) << bounds.level;
    EXPECT_LE(share_wrong(map), bounds.wrong) << bounds.level << " kept " << share_kept(map, 0, kSide);
    settings.tests.clipped_share = 0.0;  // the test turned off
    if (bounds.level == 200.0) {
      settings.tests.edge_band_slices = 0;
      EXPECT_GE(share_wrong(map_of(level, settings)), 0.004);
    }
  }
}

/// Two planes 14 slices apart, the nearer left of an edge in the middle and blurred over the farther with its coverage.
struct Planes {
  double near_grey;
  double near_contrast;
  double far_grey;
  double far_contrast;

  [[nodiscard]] double level(int x, int k, double grain) const {
    const double near_slices = k - 17.0;
    const double blur = std::hypot(0.5, 0.4 * near_slices);
    const double cover = 0.5 * (1.0 + std::erf((kSide / 2 - 0.5 - x) / (blur * std::sqrt(2.0))));
    return cover * (near_grey + near_contrast * grain * contrast(near_slices, 3.0)) +
           (1.0 - cover) * (far_grey + far_contrast * grain * contrast(k - 3.0, 3.0));
  }
  /// Of the points `first` to `end` - 1 px from the edge, on both sides or on one.
  struct Found {
    double kept = 0.0;
    double wrong = 0.0;  // of the kept
  };
  enum class Side { kBoth, kNear, kFar };
  [[nodiscard]] static Found judge(const HeightMap& map, int first, int end, Side side = Side::kBoth) {
    int points = 0;
    int kept = 0;
    int wrong = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const bool near = x < kSide / 2;
        const int away = near ? kSide / 2 - 1 - x : x - kSide / 2;
        if (away < first || away >= end || side == (near ? Side::kFar : Side::kNear)) continue;
        ++points;
        if (map.mask.at(x, y) != 0) continue;
        ++kept;
        const double truth_um = kStep_um * (near ? 17.0 : 3.0);
        wrong += std::abs(static_cast<double>(map.height_m.at(x, y)) * 1e6 - truth_um) > kStep_um ? 1 : 0;
      }
    }
    return {static_cast<double>(kept) / points, static_cast<double>(wrong) / std::max(kept, 1)};
  }
};

TEST(PointTests, TheStripBesideAWallIsNoSurface) {
  for (const Planes& planes :
       {Planes{180.0, 25.0, 40.0, 8.0}, Planes{40.0, 8.0, 180.0, 25.0}, Planes{180.0, 25.0, 5.0, 0.5},
        Planes{110.0, 20.0, 110.0, 20.0}, Planes{110.0, 22.0, 110.0, 12.0}}) {
    const Level level = [&](int x, int, int k, double grain) { return planes.level(x, k, grain); };
    const auto scene = testing::Message() << planes.near_grey << " over " << planes.far_grey;
    const HeightMap map = map_of(level);
    const bool textured = planes.far_contrast > 1.0;
    EXPECT_LE(Planes::judge(map, 0, 9).wrong, 0.1) << scene;
    EXPECT_GE(Planes::judge(map, 0, 9, Planes::Side::kNear).kept, 0.5) << scene;
    EXPECT_GE(Planes::judge(map, 0, 9, Planes::Side::kFar).kept, textured ? 0.4 : 0.0) << scene;
    EXPECT_LE(Planes::judge(map, 9, 60).wrong, 0.002) << scene;
    EXPECT_GE(Planes::judge(map, 9, 60).kept, textured ? 0.95 : 0.45) << scene;
    if (planes.near_grey == planes.far_grey) continue;
    FocusSettings off;
    off.tests.edge_band_slices = 0;
    EXPECT_GE(Planes::judge(map_of(level, off), 0, 9).wrong, 0.12) << scene;
  }
}

TEST(PointTests, AWallIsFoundAlikeByAnyNumberOfThreads) {
  const Planes planes{180.0, 25.0, 40.0, 8.0};
  const Level level = [&](int x, int y, int k, double grain) {
    return planes.level(x + (y > 80 ? 3 : 0), k, grain);  // with corners
  };
  const HeightMap one = map_of(level, {}, PeakMethod::kParabola, 1);
  const HeightMap several = map_of(level, {}, PeakMethod::kParabola, 7);
  EXPECT_TRUE(std::ranges::equal(one.mask.pixels(), several.mask.pixels()));
  int strip = 0;
  for (const MaskReasons reasons : one.mask.pixels()) strip += (reasons & mask_reason::kEdgeBand) != 0 ? 1 : 0;
  EXPECT_GT(strip, 4 * kSide);
}

TEST(PointTests, ASteepSlopeIsNoWall) {
  const HeightMap map = map_of([](int x, int, int k, double grain) {  // 0.8 slices per pixel, then back
    const int column = x % 40;
    return 100.0 + 25.0 * grain * contrast(k - 2.0 - 0.8 * std::min(column, 40 - column), 3.0);
  });
  for (const MaskReasons reasons : map.mask.pixels()) EXPECT_EQ(reasons & mask_reason::kEdgeBand, 0);
}

TEST(PointTests, APointLessCertainThanAskedForIsAHole) {
  const Level level = [](int x, int, int k, double grain) {
    return 100.0 + (x < kSide / 2 ? 30.0 : 6.0) * grain * contrast(tilted_slices(x, k), 3.0);
  };
  FocusSettings settings;
  const HeightMap all = map_of(level, settings);
  settings.tests.max_sigma_um = 0.4;
  const HeightMap some = map_of(level, settings);
  int dropped = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool uncertain = all.sigma_m.at(x, y) > 0.4e-6F;
      ASSERT_EQ(some.mask.at(x, y), all.mask.at(x, y) | (uncertain ? mask_reason::kMaxSigma : 0)) << x << ", " << y;
      ASSERT_EQ(std::isnan(some.height_m.at(x, y)), some.mask.at(x, y) != 0);
      ASSERT_EQ(std::isnan(some.sigma_m.at(x, y)), some.mask.at(x, y) != 0);
      dropped += uncertain ? 1 : 0;
    }
  }
  EXPECT_GT(dropped, kSide * kSide / 4);
  EXPECT_LT(dropped, kSide * kSide * 3 / 4);
}

}  // namespace
}  // namespace fvd
