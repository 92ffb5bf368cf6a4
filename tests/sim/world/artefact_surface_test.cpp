#include "sim/world/artefact_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "core/focus/measure/sharpness_rows.hpp"
#include "gtest/gtest.h"
#include "sim/world/sim_world.hpp"
#include "sim/world/world_config.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

WorldParameters of(SurfaceKind kind, int width_px = 480, int height_px = 360) {
  WorldParameters world;
  world.surface = kind;
  world.width_px = width_px;
  world.height_px = height_px;
  return world;
}

WorldParameters shipped(const std::string& name) { return load_world(FVD_SOURCE_DIR "/sim/worlds/" + name + ".json"); }

double height(const Surface& surface, int x, int y) { return static_cast<double>(surface.height_um.at(x, y)); }

Region region(const Surface& surface, int x, int y) { return static_cast<Region>(surface.region.at(x, y)); }

TEST(ArtefactSurface, LiesOnItsTiltedPlaneInTheScaleOfItsPixels) {
  WorldParameters world = of(SurfaceKind::kGroove, 201, 101);
  world.pixel_pitch_um = 0.5;
  world.base_um = 40.0;
  world.artefacts.tilt = {.slope_x = 0.02, .slope_y = -0.01};
  world.artefacts.groove = {.width_um = 30.0, .depth_um = 10.0};

  const Surface surface = make_surface(world);

  EXPECT_NEAR(height(surface, 100, 50), 30.0, 1e-5);
  EXPECT_NEAR(height(surface, 129, 50), 30.0 + 0.02 * 14.5, 1e-5);
  EXPECT_NEAR(height(surface, 131, 50), 40.0 + 0.02 * 15.5, 1e-5);
  EXPECT_NEAR(height(surface, 200, 100), 40.0 + 0.02 * 50.0 - 0.01 * 25.0, 1e-5);
}

TEST(ArtefactSurface, KeepsTheShippedGroovesOnTheirPixels) {
  for (const double depth_um : {10.0, 50.0, 100.0}) {
    const Surface surface = make_surface(shipped("groove_" + std::to_string(static_cast<int>(depth_um))));

    EXPECT_EQ(height(surface, 194, 5), 120.0);
    EXPECT_EQ(height(surface, 195, 5), 120.0 - depth_um);
    EXPECT_EQ(height(surface, 284, 5), 120.0 - depth_um);
    EXPECT_EQ(height(surface, 285, 5), 120.0);
  }
}

TEST(ArtefactSurface, HasTheShippedDimensions) {
  EXPECT_EQ(height(make_surface(shipped("flat")), 17, 3), 50.0);
  const Surface stairs = make_surface(shipped("stairs"));
  EXPECT_EQ(height(stairs, 119, 0), 20.0);
  EXPECT_EQ(height(stairs, 120, 0), 40.0);
  EXPECT_EQ(height(stairs, 479, 0), 120.0);
  const Surface letter = make_surface(shipped("letter_f"));
  EXPECT_EQ(height(letter, 170, 60), 70.0) << "stem and upper arm meet in the upper left";
  EXPECT_EQ(height(letter, 310, 60), 70.0);
  EXPECT_EQ(height(letter, 310, 300), 50.0);
  const Surface down = make_surface(shipped("edge_90deg"));
  EXPECT_NEAR(height(down, 0, 7), 300.0 - 239.5, 1e-4);
  EXPECT_EQ(height(down, 100, 7), height(down, 100, 350));
  const Surface polished = make_surface(shipped("edge_polished"));
  EXPECT_EQ(polished.contrast.at(240, 100), 0.03F) << "the clearance is above";
  EXPECT_EQ(polished.contrast.at(240, 180), 1.0F);
  EXPECT_EQ(std::ranges::count(polished.poor.pixels(), 1), 120 * 180);
}

TEST(ArtefactSurface, HasARadiusOnItsPixelsToo) {
  for (const double radius_um : {25.0, 10.0, 5.0}) {
    const Surface surface = make_surface(shipped("edge_r" + std::to_string(static_cast<int>(radius_um))));

    // Three pixels of the arc, whose centre lies sqrt(2) r under the ideal apex.
    for (const int row : {178, 180, 182}) {
      const double from_centre = std::hypot(row - 179.5, height(surface, 99, row) - 250.0 + std::sqrt(2.0) * radius_um);
      EXPECT_NEAR(from_centre, radius_um, 1e-4) << row;
    }
    EXPECT_NEAR(height(surface, 99, 0), 250.0 - 179.5, 1e-4);
  }
}

TEST(ArtefactSurface, LeavesWallsAndTheirNeighboursOutOfTheRegions) {
  WorldParameters world = of(SurfaceKind::kGroove);
  world.artefacts.groove = {.width_um = 90.0, .depth_um = 50.0, .wall_angle_deg = 45.0};

  const Surface surface = make_surface(world);  // walls from 170 to 220 and from 260 to 310

  EXPECT_EQ(region(surface, 157, 100), Region::kSurface);
  EXPECT_EQ(region(surface, 158, 100), Region::kNone);
  EXPECT_EQ(region(surface, 195, 100), Region::kNone) << "a wall";
  EXPECT_EQ(region(surface, 240, 100), Region::kSurface);
  EXPECT_EQ(region(surface, 5, 100), Region::kNone) << "the image's border";
}

TEST(ArtefactSurface, IsPolishedWhereRegionsAndPictureSay) {
  const test::ScratchDir scratch;
  cv::Mat picture(60, 100, CV_8U, cv::Scalar(255));
  picture.at<std::uint8_t>(10, 20) = 51;
  ASSERT_TRUE(cv::imwrite((scratch / "contrast.png").string(), picture));
  test::write_text(scratch / "world.json", R"({"surface": "rough", "width_px": 100, "height_px": 60, "contrast_map": {
    "picture_file": "contrast.png", "regions": [
      {"direction_deg": 90, "along_from_um": 0, "across_from_um": -10, "across_to_um": 20, "contrast_percent": 50},
      {"along_from_um": 10, "along_to_um": 20, "across_to_um": -5}]}})");

  const Surface surface = make_surface(load_world(scratch / "world.json"));

  EXPECT_EQ(surface.contrast.at(20, 10), 0.2F);
  EXPECT_EQ(surface.contrast.at(21, 10), 1.0F);
  EXPECT_EQ(surface.contrast.at(40, 30), 0.5F);
  EXPECT_EQ(surface.contrast.at(39, 30), 1.0F) << "left of it";
  EXPECT_EQ(surface.contrast.at(69, 33), 0.5F);
  EXPECT_EQ(surface.contrast.at(70, 33), 1.0F) << "right of it";
  EXPECT_EQ(surface.contrast.at(40, 29), 1.0F) << "above it";
  EXPECT_EQ(surface.contrast.at(60, 35), 0.03F) << "the last one counts";
  EXPECT_EQ(surface.poor.at(60, 35), 1);
  EXPECT_EQ(surface.poor.at(40, 35), 0);
  EXPECT_EQ(region(surface, 60, 40), Region::kPoor);
  EXPECT_EQ(region(surface, 50, 40), Region::kNone) << "beside it";
}

TEST(ArtefactSurface, RefusesAPictureThatDoesNotFit) {
  const test::ScratchDir scratch;
  WorldParameters world = of(SurfaceKind::kFlat, 100, 60);
  const auto refused = [&](const std::string& name, const std::string& word) {
    world.artefacts.contrast.picture_file = scratch / name;
    test::expect_error(ErrorCode::kBadInput, {name, word}, [&] { (void)make_surface(world); });
  };
  ASSERT_TRUE(cv::imwrite((scratch / "small.png").string(), cv::Mat::zeros(60, 99, CV_8U)));
  ASSERT_TRUE(cv::imwrite((scratch / "colour.png").string(), cv::Mat::zeros(60, 100, CV_8UC3)));
  ASSERT_TRUE(cv::imwrite((scratch / "deep.png").string(), cv::Mat::zeros(60, 100, CV_16U)));
  test::write_text(scratch / "text.png", "no image");

  refused("small.png", "99 x 60");
  refused("colour.png", "3 channels");
  refused("deep.png", "8 bits");
  refused("text.png", "no image");
  refused("absent.png", "missing");
}

TEST(ArtefactSurface, HasATiltedBallThatStaysRound) {
  WorldParameters world = of(SurfaceKind::kSphere, 401, 301);
  world.base_um = 20.0;
  world.radius_um = 150.0;
  world.cap_height_um = 80.0;
  world.artefacts.tilt = {.slope_x = 0.1, .slope_y = -0.2};

  const Surface surface = make_surface(world);

  const double out = -70.0 / std::sqrt(1.05);  // the centre lies 70 um under the plane, along its normal
  const auto radius = [&](int x, int y) {
    return std::hypot(x - 200 + 0.1 * out, y - 150 - 0.2 * out, height(surface, x, y) - 20.0 - out);
  };
  EXPECT_NEAR(radius(200, 150), 150.0, 1e-4);
  EXPECT_NEAR(radius(240, 120), 150.0, 1e-4);
  EXPECT_NEAR(radius(170, 190), 150.0, 1e-4);
  EXPECT_NEAR(height(surface, 0, 0), 20.0 - 20.0 + 30.0, 1e-4) << "the plane";
}

TEST(ArtefactSurface, ReportsEveryMistakeAtOnce) {
  const test::ScratchDir scratch;
  const auto refused = [&](const std::string& text, std::initializer_list<std::string> words) {
    test::write_text(scratch / "world.json", text);
    test::expect_error(ErrorCode::kBadConfig, words, [&] { (void)load_world(scratch / "world.json"); });
  };
  refused(R"({"surface": "groove", "groove": {"depth_um": -3, "widht_um": 4}, "tilt": {"slope_x": 9}, "edge": {}})",
          {"/groove/depth_um: -3", "/groove/widht_um", "'width_um'", "/tilt/slope_x: 9", "/edge: unknown key"});
  refused(R"({"surface": "groove", "groove": {"width_um": 20, "depth_um": 50, "wall_angle_deg": 45},
              "contrast_map": {"regions": [{"along_from_um": 5, "along_to_um": 5}]}})",
          {"/groove/width_um", "no bottom is left", "/contrast_map/regions/0/along_to_um"});
  refused(R"({"surface": "cross_grid", "cross_grid": {"pitch_x_um": 20, "line_width_um": 20}})",
          {"/cross_grid/line_width_um"});
  refused(R"({"surface": "edge", "edge": {"rounding": {"kind": "circle", "S_gamma_um": 5}, "beta_deg": 5}})",
          {"/edge/rounding/S_gamma_um: unknown key", "/edge/beta_deg: 5"});
  refused(R"({"surface": "edge", "edge": {"rounding": {"kind": "blunt"}}})",
          {"/edge/rounding/kind", "\"sharp\", \"circle\", \"conic\""});
  refused(R"({"surface": "edge", "edge": {"bend_radius_um": 100, "notches": [{"dept_um": 3}]}})",
          {"/edge/notches/0/dept_um", "'depth_um'"});
  refused(R"({"surface": "edge", "tilt": {"slope_x": 0.1}, "edge": {"bend_radius_um": 100}})",
          {"/tilt: ", "/edge/bend_radius_um: "});
  refused(R"({"surface": "stairs", "stairs": {"treads": [{"width_um": 3}]}})", {"/stairs/treads", "2..64"});
  refused(R"({"surface": "chapter", "tilt": {"slope_x": 0.1}})", {"/tilt: unknown key"});
  refused(R"({"surface": "layered", "contrast_map": {}})", {"/contrast_map: unknown key"});
  WorldParameters world = of(SurfaceKind::kCrossGrid);
  world.artefacts.cross_grid.line_width_um = 99.0;
  test::expect_error(ErrorCode::kBadConfig, {"line_width_um is 99"}, [&] { (void)make_surface(world); });
}

/// z of the sharpest of the slices at every pixel.
Plane<double> sharpest_um(const WorldParameters& world, const Surface& surface, double from_um, double to_um) {
  const auto renderer = make_renderer(world, surface);
  Plane<std::uint16_t> best(world.width_px, world.height_px);
  Plane<double> best_um(world.width_px, world.height_px);
  std::vector<std::uint8_t> slice(best.pixels().size());
  ExposureRequest request;
  request.width = world.width_px;
  request.height = world.height_px;
  for (double z_um = from_um; z_um <= to_um; z_um += 5.0) {
    ++request.exposure_index;
    renderer->render(z_um, request, std::as_writable_bytes(std::span(slice)));
    const auto sharpness = sharpness_reference({PixelFormat::kMono8, world.width_px, world.height_px, world.width_px,
                                                reinterpret_cast<const std::byte*>(slice.data())},
                                               {});
    for (std::size_t i = 0; i < slice.size(); ++i) {
      if (sharpness.pixels()[i] <= best.pixels()[i]) continue;
      best.pixels()[i] = sharpness.pixels()[i];
      best_um.pixels()[i] = z_um;
    }
  }
  return best_um;
}

TEST(ArtefactSurface, IsSharpestWhereItLies) {
  WorldParameters world = of(SurfaceKind::kEdge, 160, 120);
  world.readout_noise = 0.5;
  world.base_um = 80.0;
  world.artefacts.edge.direction_deg = 17.0;
  world.artefacts.edge.radius_um = 20.0;
  const Surface surface = make_surface(world);

  const Plane<double> found = sharpest_um(world, surface, -30.0, 110.0);

  double squares = 0.0;
  int count = 0;
  for (int y = 8; y < 112; ++y) {
    for (int x = 8; x < 152; ++x) {
      const double error = found.at(x, y) - height(surface, x, y);
      EXPECT_LT(std::abs(error), 16.0) << x << ", " << y;
      squares += error * error;
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 3.5) << "slices lie 5 um apart";
}

TEST(ArtefactSurface, ShowsHardlyAnyTextureWhereItIsPolished) {
  WorldParameters world = of(SurfaceKind::kFlat, 200, 100);
  world.readout_noise = 0.0;
  world.artefacts.contrast.regions = {{.along_from_um = 0.0}};
  const Surface surface = make_surface(world);
  const auto renderer = make_renderer(world, surface);
  std::vector<std::uint8_t> slice(200 * 100);
  ExposureRequest request;
  request.width = 200;
  request.height = 100;

  renderer->render(world.base_um, request, std::as_writable_bytes(std::span(slice)));

  double squares[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < slice.size(); ++i) {
    const double level = static_cast<double>(slice[i]) - 128.0;
    squares[i % 200 < 100 ? 0 : 1] += level * level;
  }
  EXPECT_NEAR(std::sqrt(squares[1] / squares[0]), 0.03, 0.006);
}

}  // namespace
}  // namespace fvd::sim
