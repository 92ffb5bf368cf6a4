/// The streaming stack against its twin that keeps everything, and against what is known.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/simple_focus_stack.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

/// A synthetic scan: texture whose contrast falls with the distance from the surface, plus noise.
struct Scan {
  PixelFormat format = PixelFormat::kMono8;
  int width = 0;
  int height = 0;
  std::vector<std::vector<std::byte>> slices;
  std::vector<double> z_um;

  [[nodiscard]] ImageView slice(std::size_t k) const {
    return {format, width, height, static_cast<std::ptrdiff_t>(width) * bytes_per_pixel(format), slices[k].data()};
  }
};

enum class Surface { kTilted, kStepped, kRandom };

double surface_um(Surface surface, int x, int y) {
  switch (surface) {
    case Surface::kTilted:
      return 10.0 + 0.8 * x + 0.3 * y;
    case Surface::kStepped:
      return x % 20 < 10 ? 20.0 : 45.0;
    case Surface::kRandom:
      return 30.0;
  }
  return 0.0;
}

Scan make_scan(PixelFormat format, Surface surface, int width, int height, int count, unsigned seed) {
  Scan scan{format, width, height, {}, {}};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> jitter(-1.5, 1.5);
  std::vector<double> texture(static_cast<std::size_t>(width * height));
  for (auto& value : texture) value = normal(random);
  const double unit = format == PixelFormat::kMono8 ? 1.0 : 256.0;
  for (int k = 0; k < count; ++k) {
    scan.z_um.push_back(5.0 * k + jitter(random));
    std::vector<std::byte> bytes(texture.size() * static_cast<std::size_t>(bytes_per_pixel(format)));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(y * width + x);
        const double defocus = (scan.z_um.back() - surface_um(surface, x, y)) / 12.0;
        const double contrast = surface == Surface::kRandom ? 30.0 : 30.0 * std::exp(-defocus * defocus);
        const double noise = surface == Surface::kRandom ? 30.0 * normal(random) : normal(random);
        const double level = std::clamp((128.0 + contrast * texture[i] + noise) * unit, 0.0, 256.0 * unit - 1.0);
        if (format == PixelFormat::kMono8) {
          bytes[i] = static_cast<std::byte>(static_cast<std::uint8_t>(level));
        } else {
          const auto wide = static_cast<std::uint16_t>(level);
          std::memcpy(&bytes[2 * i], &wide, sizeof(wide));
        }
      }
    }
    scan.slices.push_back(std::move(bytes));
  }
  return scan;
}

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

/// batch: slices pushed together.
HeightMap stream(const Scan& scan, const FocusSettings& settings, PeakMethod method, int threads,
                 std::size_t batch = 1) {
  WorkerPool pool(threads);
  StreamingFocusStack stack(scan.width, scan.height, scan.format, settings, pool);
  for (std::size_t first = 0; first < scan.slices.size(); first += batch) {
    std::vector<ZSlice> slices;
    for (std::size_t k = first; k < std::min(first + batch, scan.slices.size()); ++k) {
      slices.push_back({scan.slice(k), scan.z_um[k]});
    }
    stack.push(slices);
  }
  return stack.finish(method);
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
};

/// For the names of the tests.
void PrintTo(const Case& c, std::ostream* out) {
  *out << (c.format == PixelFormat::kMono8    ? "Mono8"
           : c.format == PixelFormat::kMono12 ? "Mono12"
                                              : "Mono16")
       << (c.surface == Surface::kTilted    ? "Tilted"
           : c.surface == Surface::kStepped ? "Stepped"
                                            : "Random")
       << c.width << "x" << c.height << "Slices" << c.slices << "Window" << c.window << "Distance" << c.distance
       << "Bin" << c.bin
       << (c.focus_operator == FocusOperator::kTenengrad   ? "Tenengrad"
           : c.focus_operator == FocusOperator::kIntensity ? "Intensity"
                                                           : "Laplacian");
}

class AStreamingStack : public testing::TestWithParam<Case> {};

TEST_P(AStreamingStack, EqualsTheOneThatKeepsEverything) {
  const Case c = GetParam();
  const Scan scan = make_scan(c.format, c.surface, c.width, c.height, c.slices, 7);
  const FocusSettings settings{.focus_operator = c.focus_operator,
                               .window_px = c.window,
                               .distance_px = c.distance,
                               .min_prominence = 0.3,
                               .min_significance = 2.0,
                               .bin_slices = c.bin};
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
    testing::Values(Case{PixelFormat::kMono8, Surface::kTilted, 53, 31, 15, 9},
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
                    Case{PixelFormat::kMono16, Surface::kTilted, 33, 21, 29, 5, 1, FocusOperator::kModifiedLaplacian,
                         4},
                    Case{PixelFormat::kMono8, Surface::kRandom, 33, 21, 3, 5, 1, FocusOperator::kModifiedLaplacian, 4},
                    Case{PixelFormat::kMono8, Surface::kTilted, 8, 8, 1, 3},
                    Case{PixelFormat::kMono8, Surface::kTilted, 8, 8, 2, 3}));

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
  StreamingFocusStack stack(3, 3, PixelFormat::kMono8,
                            {.window_px = 3, .distance_px = 1, .min_prominence = 0.5, .min_significance = 0.0}, pool);
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
}

TEST(StreamingFocusStack, StatesItsMemoryBeforehand) {
  const auto small = StreamingFocusStack::memory_bytes(2048, 2048, PixelFormat::kMono8, {}, 2);
  const auto pixels = 2048.0 * 2048.0;
  EXPECT_GT(static_cast<double>(small), 20 * pixels);
  EXPECT_LT(static_cast<double>(small), 40 * pixels);
}

}  // namespace
}  // namespace fvd
