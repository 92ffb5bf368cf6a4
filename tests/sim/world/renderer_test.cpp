/// The simulated microscope: what it shows must be what the optics of its model would show.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "core/focus/measure/sharpness_rows.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "gtest/gtest.h"
#include "sim/axis/axis_model.hpp"
#include "sim/world/defocus_renderer.hpp"
#include "sim/world/sim_world.hpp"
#include "sim/world/texture.hpp"

namespace fvd::sim {
namespace {

TEST(TransferNodes, InterpolateEveryFrequencyAtEveryBlurWithinATenthOfAPercent) {
  const TransferNodes nodes(12.0);
  double worst = 0.0;
  for (double sigma = 0.0; sigma <= 12.0; sigma += 0.007) {
    const TransferWeights weights = nodes.at(sigma);
    // x = (u^2 + v^2) / 2 runs from 0 to pi^2, both frequencies at Nyquist.
    for (double x = 0.0; x <= std::numbers::pi * std::numbers::pi; x += 0.02) {
      double transfer = 0.0;
      for (int i = 0; i < 4; ++i) {
        transfer += static_cast<double>(weights.weight[static_cast<std::size_t>(i)]) *
                    std::exp(-nodes.t()[static_cast<std::size_t>(weights.first + i)] * x);
      }
      worst = std::max(worst, std::abs(transfer - std::exp(-sigma * sigma * x)));
    }
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(worst, 1e-5) << "a bound so lax checks nothing";
  RecordProperty("worst_transfer_error", std::to_string(worst));
}

ExposureRequest whole(int width, int height, PixelFormat format = PixelFormat::kMono8) {
  ExposureRequest request;
  request.format = format;
  request.width = width;
  request.height = height;
  return request;
}

TEST(DefocusRenderer, EqualsTheDirectBlurInTheFrequencyDomain) {
  const Plane<std::uint8_t> rich(128, 96);
  const Plane<float> texture = make_texture(TextureKind::kGranite, rich, 28.0, 1.0, 5);
  const Plane<float> flat(128, 96, 0.0F);
  DefocusRenderer renderer(texture, flat, {.readout_noise = 0.0, .threads = 1});
  const FrequencyBlur direct(texture);
  std::vector<std::uint16_t> slice(128 * 96);
  double worst = 0.0;
  for (const double z_um : {0.0, 1.0, 3.0, 7.5, 12.0, 20.0, 47.0, 100.0, 250.0}) {
    renderer.render(z_um, whole(128, 96, PixelFormat::kMono16), std::as_writable_bytes(std::span(slice)));
    const Plane<float> expected = direct.blurred(std::pow(0.04 * z_um, 2));
    for (std::size_t i = 0; i < slice.size(); ++i) {
      worst = std::max(worst, std::abs(slice[i] / 256.0 - static_cast<double>(expected.pixels()[i])));
    }
  }
  EXPECT_LT(worst, 0.05) << "in 8-bit grey levels";
}

TEST(DefocusRenderer, RepeatsItsNoiseFromTheSeedAndTheExposure) {
  const Plane<float> texture(64, 32, 128.0F);
  const Plane<float> flat(64, 32, 0.0F);
  const auto slice = [&](std::uint64_t seed, std::uint64_t exposure) {
    DefocusRenderer renderer(texture, flat, {.readout_noise = 1.5, .seed = seed, .threads = 2});
    std::vector<std::uint8_t> pixels(64 * 32);
    ExposureRequest request = whole(64, 32);
    request.exposure_index = exposure;
    renderer.render(0.0, request, std::as_writable_bytes(std::span(pixels)));
    return pixels;
  };
  EXPECT_EQ(slice(1, 3), slice(1, 3));
  EXPECT_NE(slice(1, 3), slice(1, 4));
  EXPECT_NE(slice(1, 3), slice(2, 3));
  double sum = 0.0;
  double squares = 0.0;
  for (const auto value : slice(1, 9)) {
    sum += value;
    squares += value * value;
  }
  const double mean = sum / 2048;
  EXPECT_NEAR(mean, 128.0, 0.15);
  EXPECT_NEAR(std::sqrt(squares / 2048 - mean * mean), std::sqrt(1.5 * 1.5 + 1.0 / 12), 0.1);
}

TEST(DefocusRenderer, RendersARegionAsTheCutOutOfTheWhole) {
  const Plane<std::uint8_t> rich(64, 48);
  DefocusRenderer renderer(make_texture(TextureKind::kGranite, rich, 28.0, 1.0, 5), Plane<float>(64, 48, 10.0F),
                           {.readout_noise = 0.0, .threads = 1});
  std::vector<std::uint8_t> all(64 * 48);
  renderer.render(30.0, whole(64, 48), std::as_writable_bytes(std::span(all)));
  ExposureRequest request = whole(20, 10);
  request.offset_x = 7;
  request.offset_y = 5;
  std::vector<std::uint8_t> part(200);
  renderer.render(30.0, request, std::as_writable_bytes(std::span(part)));
  for (std::size_t y = 0; y < 10; ++y) {
    EXPECT_EQ(std::memcmp(&part[20 * y], &all[64 * (y + 5) + 7], 20), 0) << "row " << y;
  }
}

TEST(Texture, DoesNotSaturateAndHasItsContrast) {
  const Plane<std::uint8_t> rich(256, 256);
  const Plane<float> texture = make_texture(TextureKind::kGranite, rich, 28.0, 1.0, 9);
  double squares = 0.0;
  for (const float value : texture.pixels()) {
    ASSERT_GT(value, 10.0F);
    ASSERT_LT(value, 245.0F);
    squares += std::pow(static_cast<double>(value) - 128.0, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / (256 * 256)), 28.0, 0.5);
}

/// A world seen by an ideal axis that is moved by hand.
class ASimWorld : public testing::Test {
 protected:
  static AxisParameters ideal() {
    AxisParameters parameters;
    parameters.power_on_position_um = 0.0;
    return parameters;
  }

  /// The slice at z_um of the axis' settled position.
  std::vector<std::uint8_t> slice(SimWorld& world, double z_um) {
    time_ += std::chrono::seconds(5);
    axis_.move_to(time_, static_cast<std::int32_t>(std::lround(z_um * 100)), 1e6, 1e7, 1e7);
    time_ += std::chrono::seconds(5);
    ExposureRequest request = whole(world.sensor_width(), world.sensor_height());
    request.start = time_;
    request.end = time_ + std::chrono::milliseconds(5);
    request.exposure_index = exposure_++;
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(request.width * request.height));
    world.render(request, std::as_writable_bytes(std::span(pixels)));
    return pixels;
  }

  AxisModel axis_{ideal()};
  HostTime time_ = HostClock::now();
  std::uint64_t exposure_ = 0;
};

TEST_F(ASimWorld, IsSharpestWhereItsSurfaceIs) {
  WorldParameters parameters;
  parameters.surface = SurfaceKind::kTilted;
  parameters.width_px = 96;
  parameters.height_px = 64;
  parameters.tilt_x_um_per_px = 0.5;
  parameters.base_um = 30.0;
  parameters.readout_noise = 0.5;
  SimWorld world(parameters, axis_);
  Plane<std::uint16_t> best(96, 64);
  Plane<double> best_z(96, 64);
  for (double z_um = -10.0; z_um <= 70.0; z_um += 2.0) {
    const auto pixels = slice(world, z_um);
    const auto sharpness =
        sharpness_reference({PixelFormat::kMono8, 96, 64, 96, reinterpret_cast<const std::byte*>(pixels.data())}, {});
    for (std::size_t i = 0; i < best.pixels().size(); ++i) {
      if (sharpness.pixels()[i] <= best.pixels()[i]) continue;
      best.pixels()[i] = sharpness.pixels()[i];
      best_z.pixels()[i] = z_um;
    }
  }
  for (int y = 8; y < 56; ++y) {
    for (int x = 8; x < 88; ++x) {
      EXPECT_NEAR(best_z.at(x, y), static_cast<double>(world.surface().height_um.at(x, y)), 5.0) << x << ", " << y;
    }
  }
}

TEST_F(ASimWorld, ShowsTheChaptersFiguresThroughTheStreamingStack) {
  SimWorld world({}, axis_);
  WorkerPool pool(2);
  StreamingFocusStack stack(480, 360, PixelFormat::kMono8, {}, pool);
  for (int k = 0; k < 21; ++k) {
    const auto pixels = slice(world, -7.0 + 10.0 * k);
    stack.push({PixelFormat::kMono8, 480, 360, 480, reinterpret_cast<const std::byte*>(pixels.data())},
               -7.0 + 10.0 * k);
  }
  struct Figures {
    double plateau_rms_um;
    double ramp_rms_um;
  };
  const auto figures = [&](PeakMethod method) {
    const HeightMap map = stack.finish(method);
    double squares[2] = {0.0, 0.0};
    double counts[2] = {0.0, 0.0};
    for (std::size_t i = 0; i < map.mask.pixels().size(); ++i) {
      const auto region = static_cast<Region>(world.surface().region.pixels()[i]);
      if (map.mask.pixels()[i] != 0 || region == Region::kNone || region == Region::kPoor) continue;
      const int which = region == Region::kRamp ? 1 : 0;
      const double error = static_cast<double>(map.height_m.pixels()[i]) * 1e6 -
                           static_cast<double>(world.surface().height_um.pixels()[i]);
      squares[which] += error * error;
      counts[which] += 1.0;
    }
    const Figures result{std::sqrt(squares[0] / counts[0]), std::sqrt(squares[1] / counts[1])};
    std::printf("%-12s plateaus %.3f um, ramp %.3f um\n", std::string(peak_method_name(method)).c_str(),
                result.plateau_rms_um, result.ramp_rms_um);
    return result;
  };
  EXPECT_NEAR(figures(PeakMethod::kNearest).plateau_rms_um, 3.00, 0.05);
  EXPECT_LE(figures(PeakMethod::kParabola).plateau_rms_um, 0.65);
  const Figures log_parabola = figures(PeakMethod::kLogParabola);
  EXPECT_LE(log_parabola.plateau_rms_um, 0.40);
  EXPECT_LE(log_parabola.ramp_rms_um, 0.40);
  const HeightMap map = stack.finish(PeakMethod::kLogParabola);
  double textured[2] = {0.0, 0.0};
  double poor[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < map.mask.pixels().size(); ++i) {
    const auto region = static_cast<Region>(world.surface().region.pixels()[i]);
    if (region == Region::kNone) continue;
    auto& tally = region == Region::kPoor ? poor : textured;
    tally[0] += 1.0;
    tally[1] += map.mask.pixels()[i] == 0 ? 1.0 : 0.0;
  }
  std::printf("textured valid %.5f, texture-poor valid %.3f\n", textured[1] / textured[0], poor[1] / poor[0]);
  EXPECT_GE(textured[1] / textured[0], 0.999);
  EXPECT_LE(poor[1] / poor[0], 0.30) << "the patch is a hole but for its border, where windows reach texture";
}

}  // namespace
}  // namespace fvd::sim
