/// The streaming stack against what is known.

#include "core/focus/streaming_focus_stack.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/simple_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "gtest/gtest.h"
#include "tests/core/focus/synthetic_scan.hpp"

namespace fvd {
namespace {

TEST(StreamingFocusStack, MarksHolesWithNaNAndNothingElse) {
  const HeightMap map =
      stream(make_scan(PixelFormat::kMono8, Surface::kRandom, 50, 40, 9, 1), {}, PeakMethod::kParabola, 2);
  int holes = 0;
  for (std::size_t i = 0; i < map.mask.pixels().size(); ++i) {
    EXPECT_EQ(std::isnan(map.height_m.pixels()[i]), map.mask.pixels()[i] != 0);
    holes += map.mask.pixels()[i] != 0 ? 1 : 0;
  }
  EXPECT_GT(holes, 1900) << "noise without a surface has no peak";
}

TEST(StreamingFocusStack, FollowsATiltedSurface) {
  const HeightMap map =
      stream(make_scan(PixelFormat::kMono16, Surface::kTilted, 60, 40, 20, 3), {}, PeakMethod::kLogParabola, 2);
  double squares = 0.0;
  int valid = 0;
  for (int y = 8; y < 32; ++y) {
    for (int x = 8; x < 52; ++x) {
      if (map.mask.at(x, y) != 0) continue;
      const double error = static_cast<double>(map.height_m.at(x, y)) * 1e6 - surface_um(Surface::kTilted, x, y);
      squares += error * error;
      ++valid;
    }
  }
  ASSERT_GT(valid, 1000);
  EXPECT_LT(std::sqrt(squares / valid), 1.0);
}

/// A chequered plane, in focus at its own height in every column, whose contrast follows F = (1 + b u^2)^-1.4.
TEST(StreamingFocusStack, TakesTheRippleOfCurvesOfAnotherShapeOff) {
  constexpr int kWidth = 220;
  constexpr int kHeight = 200;
  constexpr double kStep_um = 10.0;
  constexpr double kCurveWidth_um = 30.0;
  constexpr double kExponent = 1.4;
  const auto surface = [](int x) { return 60.0 + 0.23 * x; };  // over five steps
  const double bend = 4.0 * (std::exp2(1.0 / kExponent) - 1.0) / (kCurveWidth_um * kCurveWidth_um);
  WorkerPool pool(2);
  FocusSettings settings;
  settings.distance_px = 1;
  settings.stage_correction = false;
  StreamingFocusStack stack(kWidth, kHeight, PixelFormat::kMono16, settings, pool);
  for (int k = 0; k < 18; ++k) {
    Plane<std::uint16_t> slice(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double away = kStep_um * k - surface(x);
        const double contrast = 20000.0 * std::pow(1.0 + bend * away * away, -kExponent);
        slice.at(x, y) = static_cast<std::uint16_t>(std::lround(30000.0 + ((x + y) % 2 == 0 ? contrast : -contrast)));
      }
    }
    stack.push(image_view(slice.view(), PixelFormat::kMono16), kStep_um * k);
  }
  const HeightMap map = stack.finish(PeakMethod::kFiveSample);
  EXPECT_NEAR(map.curve_width_um, kCurveWidth_um, 0.6);
  double squares = 0.0;
  int points = 0;
  for (int y = 10; y < kHeight - 10; y += 7) {
    for (int x = 10; x < kWidth - 10; ++x) {
      ASSERT_EQ(map.mask.at(x, y), 0);
      const double error = static_cast<double>(map.height_m.at(x, y)) * 1e6 - surface(x);
      squares += error * error;
      ++points;
    }
  }
  // Without knowing the shape it is 0.035 um.
  EXPECT_LT(std::sqrt(squares / points), 0.015);
}

TEST(StreamingFocusStack, NeedsTheSameMemoryForFewAndForManySlices) {
  const Scan scan = make_scan(PixelFormat::kMono8, Surface::kTilted, 64, 48, 3, 5);
  WorkerPool pool(1);
  StreamingFocusStack stack(scan.width, scan.height, scan.format, {}, pool);
  const double empty = stack.state_bytes_per_pixel();
  for (int k = 0; k < 21; ++k) stack.push(scan.slice(static_cast<std::size_t>(k % 3)), k);
  const double after_21 = stack.state_bytes_per_pixel();
  for (int k = 21; k < 2000; ++k) stack.push(scan.slice(static_cast<std::size_t>(k % 3)), k);
  EXPECT_EQ(after_21, empty);
  EXPECT_EQ(stack.state_bytes_per_pixel(), after_21);
  EXPECT_EQ(stack.slices(), 2000);
  EXPECT_EQ(after_21, 20.0);
  FocusSettings settings;
  settings.tests.second_peak = 0.8;
  EXPECT_EQ(StreamingFocusStack(scan.width, scan.height, scan.format, settings, pool).state_bytes_per_pixel(), 22.0);
}

TEST(StreamingFocusStack, TakesNoMoreThanItsIndexCanCount) {
  const Scan scan = make_scan(PixelFormat::kMono8, Surface::kRandom, 1, 1, 2, 5);
  WorkerPool pool(1);
  StreamingFocusStack stack(1, 1, PixelFormat::kMono8,
                            {.window_px = 3, .distance_px = 1, .min_prominence = 0.0, .min_significance = 0.0}, pool);
  for (int k = 0; k < StreamingFocusStack::kMaxSlices; ++k) stack.push(scan.slice(0), k);
  EXPECT_THROW(stack.push(scan.slice(0), 1e6), Error);
  EXPECT_EQ(stack.slices(), StreamingFocusStack::kMaxSlices);
}

/// A stack of 3 x 3 slices of uniform contrast per slice.
HeightMap of_contrasts(const std::vector<int>& contrasts, int base = 100) {
  WorkerPool pool(1);
  FocusSettings settings{.window_px = 3, .distance_px = 1, .min_prominence = 0.5, .min_significance = 0.0};
  settings.tests.clipped_share = 0.1;  // less than a pixel of nine
  StreamingFocusStack stack(3, 3, PixelFormat::kMono8, settings, pool);
  double z_um = 0.0;
  for (const int contrast : contrasts) {
    Plane<std::uint8_t> slice(3, 3, static_cast<std::uint8_t>(base));
    slice.at(1, 1) = static_cast<std::uint8_t>(base + contrast);
    stack.push(image_view(slice.view(), PixelFormat::kMono8), z_um);
    z_um += 10.0;
  }
  return stack.finish(PeakMethod::kParabola);
}

TEST(StreamingFocusStack, TellsAPeakAtTheFirstSlice) {
  EXPECT_EQ(of_contrasts({90, 40, 10}).mask.at(1, 1), mask_reason::kFirstSlice);
}

TEST(StreamingFocusStack, TellsAPeakAtTheLastSlice) {
  EXPECT_EQ(of_contrasts({10, 40, 90}).mask.at(1, 1), mask_reason::kLastSlice);
}

TEST(StreamingFocusStack, TellsAFlatCurveAsLowProminence) {
  EXPECT_EQ(of_contrasts({80, 90, 80}).mask.at(1, 1), mask_reason::kLowProminence);
  EXPECT_NE(of_contrasts({0, 0, 0}).mask.at(1, 1) & mask_reason::kLowProminence, 0);
}

TEST(StreamingFocusStack, TellsSaturationAtThePeakOnly) {
  EXPECT_EQ(of_contrasts({10, 155, 10}).mask.at(1, 1), mask_reason::kSaturated);
  EXPECT_EQ(of_contrasts({10, 154, 10}).mask.at(1, 1), 0);
}

TEST(StreamingFocusStack, TakesTheFirstOfEqualPeaks) {
  const HeightMap map = of_contrasts({10, 90, 90, 10});
  EXPECT_NEAR(static_cast<double>(map.height_m.at(1, 1)), 15e-6, 1e-10) << "half way to the equal neighbour";
}

TEST(StreamingFocusStack, KeepsTheGreyLevelOfThePeakSlice) {
  EXPECT_EQ(of_contrasts({10, 90, 20}).texture.at(1, 1), 190);
}

/// Heights of a scan whose z are changed by `change`; order backwards if asked for.
Plane<float> heights_with(const Scan& scan, const std::function<double(double)>& change, bool backwards = false) {
  Scan changed = scan;
  for (double& z : changed.z_um) z = change(z);
  if (backwards) {
    std::reverse(changed.z_um.begin(), changed.z_um.end());
    std::reverse(changed.slices.begin(), changed.slices.end());
  }
  FocusSettings settings;
  settings.stage_correction = false;
  return stream(changed, settings, PeakMethod::kFiveSample, 2).height_m;
}

TEST(StreamingFocusStack, FollowsAShiftAScaleAndTheReversedOrderOfZ) {
  const Scan scan = make_scan(PixelFormat::kMono16, Surface::kTilted, 60, 40, 24, 3);
  const Plane<float> plain = heights_with(scan, [](double z) { return z; });
  const Plane<float> shifted = heights_with(scan, [](double z) { return z + 1000.0; });
  const Plane<float> scaled = heights_with(scan, [](double z) { return 2.0 * z; });
  const Plane<float> reversed = heights_with(
      scan, [](double z) { return z; }, true);
  int compared = 0;
  int ties = 0;
  for (std::size_t i = 0; i < plain.pixels().size(); ++i) {
    const double height_um = static_cast<double>(plain.pixels()[i]) * 1e6;
    if (std::isnan(height_um)) continue;
    EXPECT_NEAR(static_cast<double>(shifted.pixels()[i]) * 1e6, height_um + 1000.0, 2e-4);
    EXPECT_NEAR(static_cast<double>(scaled.pixels()[i]) * 1e6, 2.0 * height_um, 1e-4);
    // Of two equal samples the first counts as the peak, which is the other one backwards.
    const double difference = std::abs(static_cast<double>(reversed.pixels()[i]) * 1e6 - height_um);
    EXPECT_LT(difference, 0.3);
    ties += difference > 1e-3 ? 1 : 0;
    ++compared;
  }
  EXPECT_GT(compared, 1500);
  EXPECT_LT(ties, compared / 100);
}

TEST(StreamingFocusStack, DoesNotMindTheLossOfASliceFarFromThePeakAndLittleOfOneNearIt) {
  const Scan flat = make_scan(PixelFormat::kMono16, Surface::kStepped, 10, 40, 24, 9);  // all of it at 20 um
  FocusSettings settings;
  settings.stage_correction = false;
  const auto without = [&](std::size_t lost) {
    Scan rest = flat;
    rest.slices.erase(rest.slices.begin() + static_cast<std::ptrdiff_t>(lost));
    rest.z_um.erase(rest.z_um.begin() + static_cast<std::ptrdiff_t>(lost));
    return stream(rest, settings, PeakMethod::kFiveSample, 1);
  };
  const HeightMap whole = stream(flat, settings, PeakMethod::kFiveSample, 1);
  const HeightMap far = without(20);
  const HeightMap near = without(6);  // two slices above the surface
  for (int y = 8; y < 32; ++y) {
    ASSERT_EQ(whole.mask.at(5, y), 0);
    EXPECT_NEAR(static_cast<double>(far.height_m.at(5, y)), static_cast<double>(whole.height_m.at(5, y)), 2e-8);
    EXPECT_NEAR(static_cast<double>(near.height_m.at(5, y)), static_cast<double>(whole.height_m.at(5, y)),
                6.0 * static_cast<double>(whole.sigma_m.at(5, y)));
  }
}

TEST(StreamingFocusStack, KeepsTheColoursOfThePeak) {
  const Scan scan = make_scan(PixelFormat::kMono8, Surface::kTilted, 30, 20, 23, 11);
  // The colours of a slice name it.
  std::vector<std::vector<std::uint8_t>> colours;
  for (std::size_t k = 0; k < scan.slices.size(); ++k) {
    auto& colour = colours.emplace_back(30 * 20 * 3);
    for (std::size_t i = 0; i < colour.size(); ++i) colour[i] = static_cast<std::uint8_t>(10 * k + i % 3);
  }
  for (const int bin : {1, 2, 5}) {  // 23 slices leave a bin open
    for (const std::size_t batch : {std::size_t{1}, std::size_t{4}, std::size_t{23}}) {
      WorkerPool pool(2);
      StreamingFocusStack stack(30, 20, PixelFormat::kMono8, {.bin_slices = bin}, pool, true);
      std::vector<ZSlice> slices;
      for (std::size_t k = 0; k < scan.slices.size(); ++k) {
        slices.push_back({scan.slice(k), scan.z_um[k], colours[k].data()});
      }
      for (std::size_t first = 0; first < slices.size(); first += batch) {
        stack.push(std::span(slices).subspan(first, std::min(batch, slices.size() - first)));
      }
      const HeightMap map = stack.finish(PeakMethod::kNearest);
      for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 30; ++x) {
          const int slice = map.colour.at(3 * x, y) / 10;
          ASSERT_EQ(map.colour.at(3 * x + 2, y), 10 * slice + 2);
          const auto expected = static_cast<std::uint8_t>(
              scan.slices[static_cast<std::size_t>(slice)][static_cast<std::size_t>(30 * y + x)]);
          ASSERT_EQ(map.texture.at(x, y), expected)
              << "grey and colour are of one slice; bin " << bin << ", batch " << batch << ", at " << x << ", " << y;
        }
      }
    }
  }
}

TEST(StreamingFocusStack, ScalesSharpnessByTheGainAsItsTwinDoes) {
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kMono16}) {
    for (const FocusOperator op : kAllFocusOperators) {
      const Scan scan = make_scan(format, Surface::kTilted, 61, 40, 15, 3);
      FocusSettings settings;
      settings.focus_operator = op;
      WorkerPool pool(2);
      StreamingFocusStack stack(61, 40, format, settings, pool);
      SimpleFocusStack twin(settings);
      std::vector<ZSlice> slices;
      for (std::size_t k = 0; k < scan.slices.size(); ++k) {
        const double gain = 1.0 + 0.1 * std::sin(static_cast<double>(3 * k));
        slices.push_back({scan.slice(k), scan.z_um[k], nullptr, gain});
        twin.push(scan.slice(k), scan.z_um[k], gain);
      }
      stack.push(slices);
      const HeightMap map = stack.finish(PeakMethod::kFiveSample);
      const HeightMap other = twin.finish(PeakMethod::kFiveSample);
      for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 61; ++x) {
          ASSERT_EQ(map.mask.at(x, y), other.mask.at(x, y));
          if (map.mask.at(x, y) != 0) continue;
          ASSERT_EQ(map.height_m.at(x, y), other.height_m.at(x, y));
        }
      }
    }
  }
}

TEST(StreamingFocusStack, RefusesAGreySliceAmongColours) {
  WorkerPool pool(1);
  StreamingFocusStack stack(4, 4, PixelFormat::kMono8, {}, pool, true);
  const Plane<std::uint8_t> slice(4, 4);
  EXPECT_THROW(stack.push(image_view(slice.view(), PixelFormat::kMono8), 0), Error);
  EXPECT_EQ(stack.slices(), 0);
}

TEST(StreamingFocusStack, RefusesAMapWithoutSlices) {
  WorkerPool pool(1);
  const StreamingFocusStack stack(4, 4, PixelFormat::kMono8, {}, pool);
  EXPECT_THROW((void)stack.finish(PeakMethod::kParabola), Error);
}

TEST(StreamingFocusStack, RefusesSlicesThatDoNotFitAndStaysAsItWas) {
  WorkerPool pool(1);
  StreamingFocusStack stack(4, 4, PixelFormat::kMono8, {}, pool);
  const Plane<std::uint8_t> other(5, 4);
  const Plane<std::uint16_t> wide(4, 4);
  const Plane<std::uint8_t> good(4, 4);
  EXPECT_THROW(stack.push(image_view(other.view(), PixelFormat::kMono8), 0), Error);
  EXPECT_THROW(stack.push(image_view(wide.view(), PixelFormat::kMono16), 0), Error);
  EXPECT_THROW(stack.push(image_view(good.view(), PixelFormat::kMono8), std::nan("")), Error);
  EXPECT_EQ(stack.slices(), 0);
}

TEST(StreamingFocusStack, RefusesBadSettings) {
  WorkerPool pool(1);
  for (const int window : {-1, 0, 1, 2, 8, 64, 65}) {
    EXPECT_THROW(StreamingFocusStack(4, 4, PixelFormat::kMono8, {.window_px = window, .min_prominence = 0.5}, pool),
                 Error)
        << window;
  }
  for (const int distance : {-1, 0, 8}) {
    EXPECT_THROW(StreamingFocusStack(4, 4, PixelFormat::kMono8, {.distance_px = distance}, pool), Error) << distance;
  }
  EXPECT_THROW(StreamingFocusStack(4, 4, PixelFormat::kMono8, {.window_px = 9, .min_prominence = 1.5}, pool), Error);
  EXPECT_THROW(StreamingFocusStack(0, 4, PixelFormat::kMono8, {}, pool), Error);
  for (const double second_peak : {-0.1, 1e-9, 0.3, 0.49, 1.1, std::nan("")}) {
    FocusSettings settings;
    settings.tests.second_peak = second_peak;
    EXPECT_THROW(StreamingFocusStack(4, 4, PixelFormat::kMono8, settings, pool), Error) << second_peak;
  }
}

TEST(StreamingFocusStack, StatesItsMemoryBeforehand) {
  const auto small = StreamingFocusStack::memory_bytes(2048, 2048, PixelFormat::kMono8, {}, 2);
  const auto pixels = 2048.0 * 2048.0;
  EXPECT_GT(static_cast<double>(small), 20 * pixels);
  EXPECT_LT(static_cast<double>(small), 40 * pixels);
}

}  // namespace
}  // namespace fvd
