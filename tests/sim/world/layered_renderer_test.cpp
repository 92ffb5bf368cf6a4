#include "sim/world/layered_renderer.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/focus/measure/sharpness_rows.hpp"
#include "gtest/gtest.h"
#include "sim/world/sim_world.hpp"
#include "sim/world/surface.hpp"
#include "sim/world/world_config.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 96;

WorldParameters layered(const Layer& near, const Layer& far) {
  WorldParameters world;
  world.surface = SurfaceKind::kLayered;
  world.width_px = kWidth;
  world.height_px = kHeight;
  world.base_um = 40.0;
  world.layer_gap_um = 300.0;
  world.near = near;
  world.far = far;
  world.readout_noise = 0.0;
  return world;
}

std::vector<std::uint16_t> slice(LayeredRenderer& renderer, double z_um) {
  ExposureRequest request;
  request.format = PixelFormat::kMono16;
  request.width = kWidth;
  request.height = kHeight;
  std::vector<std::uint16_t> pixels(static_cast<std::size_t>(kWidth) * kHeight);
  renderer.render(z_um, request, std::as_writable_bytes(std::span(pixels)));
  return pixels;
}

double level(const std::vector<std::uint16_t>& pixels, int x, int y) {
  return pixels[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] / 256.0;
}

TEST(LayeredRenderer, LaysTheNearPlanesBlurredCoverageOverTheFarPlane) {
  LayeredRenderer renderer(layered({200.0, 0.0}, {50.0, 0.0}), 1);
  for (const double z_um : {340.0, 315.0, 240.0, 40.0}) {
    const auto pixels = slice(renderer, z_um);
    const double sigma_px = 0.04 * (340.0 - z_um);
    for (int x = 0; x < kWidth; ++x) {
      const double beyond_px = x - (kWidth / 2 - 0.5);
      const double step = beyond_px < 0 ? 1.0 : 0.0;
      const double coverage = sigma_px == 0.0 ? step : 0.5 * std::erfc(beyond_px / (sigma_px * std::numbers::sqrt2));
      EXPECT_NEAR(level(pixels, x, 40), 50.0 + 150.0 * coverage, 1.5) << "z " << z_um << " x " << x;
    }
  }
}

TEST(LayeredRenderer, LeavesTheFarPlaneSharpBesideTheNearPlanesBlur) {
  const WorldParameters world = layered({150.0, 26.0}, {50.0, 8.0});
  LayeredRenderer both(world, 1);
  LayeredRenderer far_alone(layered({0.0, 0.0}, {50.0, 8.0}), 1);
  const auto focused = slice(both, 40.0);
  const auto alone = slice(far_alone, 40.0);
  // Three and a half blurs of 12 px from the edge nothing of the near plane is left.
  for (int x = kWidth / 2 + 42; x < kWidth; ++x) EXPECT_NEAR(level(focused, x, 50), level(alone, x, 50), 0.1) << x;
  // Right at the edge half of the far plane is seen, under half of the near plane's mean.
  double mean = 0.0;
  for (int y = 0; y < kHeight; ++y) mean += level(focused, kWidth / 2, y) / kHeight;
  EXPECT_NEAR(mean, 100.0, 8.0);
}

TEST(LayeredRenderer, IsSharpestWhereEachPlaneIs) {
  for (const double radius_px : {0.0, 40.0}) {
    WorldParameters world = layered({128.0, 28.0}, {128.0, 28.0});
    world.edge_radius_px = radius_px;
    LayeredRenderer renderer(world);
    const Surface surface = make_surface(world);
    Plane<std::uint16_t> best(kWidth, kHeight);
    Plane<double> best_z(kWidth, kHeight);
    for (double z_um = 0.0; z_um <= 380.0; z_um += 20.0) {
      const auto pixels = slice(renderer, z_um);
      const auto sharpness = sharpness_reference(
          {PixelFormat::kMono16, kWidth, kHeight, 2 * kWidth, reinterpret_cast<const std::byte*>(pixels.data())}, {});
      for (std::size_t i = 0; i < best.pixels().size(); ++i) {
        if (sharpness.pixels()[i] <= best.pixels()[i]) continue;
        best.pixels()[i] = sharpness.pixels()[i];
        best_z.pixels()[i] = z_um;
      }
    }
    int compared = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (static_cast<Region>(surface.region.at(x, y)) != Region::kSurface) continue;
        ++compared;
        ASSERT_EQ(best_z.at(x, y), static_cast<double>(surface.height_um.at(x, y))) << x << ", " << y;
      }
    }
    EXPECT_GT(compared, kWidth * kHeight / 4);
  }
}

TEST(LayeredRenderer, RendersARegionAsTheCutOutOfTheWhole) {
  LayeredRenderer renderer(layered({150.0, 26.0}, {50.0, 8.0}), 2);
  const auto all = slice(renderer, 200.0);
  ExposureRequest request;
  request.format = PixelFormat::kMono16;
  request.width = 30;
  request.height = 20;
  request.offset_x = 70;
  request.offset_y = 9;
  std::vector<std::uint16_t> part(600);
  renderer.render(200.0, request, std::as_writable_bytes(std::span(part)));
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) {
      EXPECT_EQ(part[static_cast<std::size_t>(30 * y + x)] / 256.0, level(all, 70 + x, 9 + y)) << x << ", " << y;
    }
  }
}

TEST(LayeredSurface, HasTheNearHeightWhereTheNearPlaneCoversWholePixels) {
  WorldParameters world = layered({150.0, 26.0}, {8.0, 0.0});
  const Surface straight = make_surface(world);
  EXPECT_EQ(straight.height_um.at(79, 10), 340.0F);
  EXPECT_EQ(straight.height_um.at(80, 10), 40.0F);
  EXPECT_EQ(straight.poor.at(79, 10), 0);
  EXPECT_EQ(straight.poor.at(80, 10), 1);
  const auto region = [](const Surface& surface, int x, int y) { return static_cast<Region>(surface.region.at(x, y)); };
  EXPECT_EQ(region(straight, 40, 48), Region::kSurface);
  EXPECT_EQ(region(straight, 120, 48), Region::kPoor);
  EXPECT_EQ(region(straight, 75, 48), Region::kNone) << "beside the edge";
  EXPECT_EQ(region(straight, 5, 48), Region::kNone) << "beside the border";
  world.edge_radius_px = 30.0;
  const Surface disc = make_surface(world);
  for (const int x : {51, 108}) EXPECT_EQ(disc.height_um.at(x, 48), 340.0F) << x;
  for (const int x : {49, 110}) EXPECT_EQ(disc.height_um.at(x, 48), 40.0F) << x;
  EXPECT_NEAR(near_coverage(world, 49, 47), 0.0, 0.01);
  EXPECT_GT(near_coverage(world, 101, 69), 0.0);
  EXPECT_LT(near_coverage(world, 101, 69), 1.0) << "a pixel that the edge cuts";
}

TEST(LayeredWorld, IsReadFromItsKeysAndSeenByTheSimulatedCamera) {
  const test::ScratchDir directory;
  test::write_text(directory / "world.json", R"({"surface": "layered", "width_px": 160, "height_px": 96, "base_um": 40,
      "layer_gap_um": 250, "edge_radius_px": 35, "near_grey": 150, "near_contrast": 20, "far_grey": 30, "far_contrast": 5,
      "readout_noise": 0})");
  const WorldParameters world = load_world(directory / "world.json");
  EXPECT_EQ(world.layer_gap_um, 250.0);
  EXPECT_EQ(world.edge_radius_px, 35.0);
  EXPECT_EQ(world.near.grey, 150.0);
  EXPECT_EQ(world.near.contrast, 20.0);
  EXPECT_EQ(world.far.grey, 30.0);
  EXPECT_EQ(world.far.contrast, 5.0);
  AxisParameters ideal;
  ideal.power_on_position_um = 120.0;
  const AxisModel axis(ideal);
  SimWorld seen(world, axis);
  ExposureRequest request;
  request.format = PixelFormat::kMono16;
  request.width = seen.sensor_width();
  request.height = seen.sensor_height();
  request.start = HostClock::now();
  request.end = request.start + std::chrono::milliseconds(5);
  std::vector<std::uint16_t> pixels(static_cast<std::size_t>(kWidth) * kHeight);
  seen.render(request, std::as_writable_bytes(std::span(pixels)));
  LayeredRenderer direct(world);
  EXPECT_EQ(pixels, slice(direct, 120.0));
  test::write_text(directory / "world.json", R"({"surface": "layered", "layer_gap_um": -5, "near_grey": 400})");
  test::expect_error(ErrorCode::kBadConfig, {"/layer_gap_um", "/near_grey"},
                     [&] { (void)load_world(directory / "world.json"); });
}

}  // namespace
}  // namespace fvd::sim
