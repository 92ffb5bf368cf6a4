#include "sim/world/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "sim/world/gsf_reader.hpp"
#include "sim/world/world_config.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

TEST(Surface, ChapterHasItsPlateausRampAndPatch) {
  const Surface surface = make_surface({});
  EXPECT_EQ(surface.height_um.at(60, 180), 0.0F);
  EXPECT_EQ(surface.height_um.at(130, 10), 50.0F);
  EXPECT_EQ(surface.height_um.at(300, 180), 100.0F);
  EXPECT_EQ(surface.height_um.at(360, 0), 100.0F);
  EXPECT_EQ(surface.height_um.at(479, 359), 160.0F);
  EXPECT_EQ(std::ranges::count(surface.poor.pixels(), 1), 6600);
  EXPECT_EQ(std::ranges::count(surface.region.pixels(), static_cast<std::uint8_t>(Region::kPoor)), 6600);
}

TEST(Surface, ChapterHasOneSizeOnly) {
  WorldParameters world;
  world.width_px = 640;
  EXPECT_THROW((void)make_surface(world), Error);
}

TEST(Surface, RoughHasExactlyItsSq) {
  WorldParameters world;
  world.surface = SurfaceKind::kRough;
  world.width_px = 200;
  world.height_px = 150;
  world.sq_um = 3.0;
  const Surface surface = make_surface(world);
  double sum = 0.0;
  double squares = 0.0;
  for (const float height : surface.height_um.pixels()) {
    sum += static_cast<double>(height);
    squares += static_cast<double>(height) * static_cast<double>(height);
  }
  const double mean = sum / 30000;
  EXPECT_NEAR(mean, world.base_um, 1e-3);
  EXPECT_NEAR(std::sqrt(squares / 30000 - mean * mean), 3.0, 1e-3);
}

TEST(Surface, SphereHasItsApexAndItsPlane) {
  WorldParameters world;
  world.surface = SurfaceKind::kSphere;
  world.width_px = 401;
  world.height_px = 301;
  world.base_um = 20.0;
  world.radius_um = 150.0;
  world.cap_height_um = 80.0;
  const Surface surface = make_surface(world);
  EXPECT_NEAR(static_cast<double>(surface.height_um.at(200, 150)), 100.0, 1e-4);
  EXPECT_NEAR(static_cast<double>(surface.height_um.at(250, 150)), 100.0 - 150.0 + std::sqrt(150.0 * 150 - 50 * 50),
              1e-4);
  EXPECT_EQ(surface.height_um.at(0, 0), 20.0F);
}

/// A GSF file of 3 x 2 heights with the header given.
std::filesystem::path gsf(const std::filesystem::path& directory, const std::string& header, std::size_t floats = 6,
                          float value = 2e-6F) {
  const auto file = directory / "map.gsf";
  std::ofstream out(file, std::ios::binary);
  out << header;
  for (std::size_t i = 0; i < 4 - header.size() % 4; ++i) out.put('\0');
  const std::vector<float> data(floats, value);
  out.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(floats * sizeof(float)));
  return file;
}

TEST(GsfReader, ReadsHeightsInMetresWhateverThePadding) {
  const test::ScratchDir directory;
  for (const std::string extra : {"", "T = a\n", "T = ab\n", "T = abc\n"}) {
    const auto heights = read_gsf_um(gsf(directory.path(), "Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 2\n" + extra));
    ASSERT_EQ(heights.width(), 3);
    ASSERT_EQ(heights.height(), 2);
    EXPECT_NEAR(static_cast<double>(heights.at(2, 1)), 2.0, 1e-5);
  }
}

TEST(GsfReader, RefusesEveryKindOfBadFile) {
  const test::ScratchDir directory;
  const std::string good = "Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 2\n";
  const auto refused = [&](const std::string& header, std::size_t floats = 6, float value = 1.0F) {
    try {
      (void)read_gsf_um(gsf(directory.path(), header, floats, value));
    } catch (const Error& error) {
      return error.code() == ErrorCode::kBadInput && std::string(error.what()).find("map.gsf") != std::string::npos;
    }
    return false;
  };
  EXPECT_FALSE(refused(good));
  EXPECT_TRUE(refused("Something else\n"));
  EXPECT_TRUE(refused("Gwyddion Simple Field 1.0\nXRes = 3\n"));
  EXPECT_TRUE(refused("Gwyddion Simple Field 1.0\nXRes = -3\nYRes = 2\n"));
  EXPECT_TRUE(refused("Gwyddion Simple Field 1.0\nXRes = 99999999999\nYRes = 2\n"));
  EXPECT_TRUE(refused("Gwyddion Simple Field 1.0\nXRes 3\nYRes = 2\n"));
  EXPECT_TRUE(refused(good + "ZUnits = V\n"));
  EXPECT_TRUE(refused(good, 5));
  EXPECT_TRUE(refused(good, 7));
  EXPECT_TRUE(refused(good, 6, std::nanf("")));
  EXPECT_THROW((void)read_gsf_um(directory.path() / "absent.gsf"), Error);
}

TEST(WorldConfig, ReadsEveryShippedFile) {
  for (const auto& entry : std::filesystem::directory_iterator(FVD_SOURCE_DIR "/sim/worlds")) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_NO_THROW((void)make_surface(load_world(entry.path()))) << entry.path();
  }
  for (const auto& entry : std::filesystem::directory_iterator(FVD_SOURCE_DIR "/sim/plants")) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_NO_THROW((void)load_plant(entry.path())) << entry.path();
  }
}

TEST(WorldConfig, ReadsEveryErrorOfAPlant) {
  const test::ScratchDir directory;
  const auto file = directory.path() / "plant.json";
  std::ofstream(file) << R"({"lead_phase_deg": 30, "scale_error": -0.001, "temperature_c": 21,
                             "temperature_rate_k_per_min": 0.2, "drift_um_per_k": 3.5, "feedback": "linear_scale"})";
  const AxisParameters plant = load_plant(file);
  EXPECT_EQ(plant.lead_phase_deg, 30.0);
  EXPECT_EQ(plant.scale_error, -0.001);
  EXPECT_EQ(plant.temperature_c, 21.0);
  EXPECT_EQ(plant.temperature_rate_k_per_min, 0.2);
  EXPECT_EQ(plant.drift_um_per_k, 3.5);
  EXPECT_EQ(plant.feedback, Feedback::kLinearScale);
}

TEST(WorldConfig, ReportsAllMistakesWithTheirPlace) {
  const test::ScratchDir directory;
  const auto file = directory.path() / "world.json";
  std::ofstream(file) << R"({"surface": "moon", "width_px": 5, "tilt_x_um_per_px": "steep", "sead": 1})";
  try {
    (void)load_world(file);
    FAIL() << "accepted";
  } catch (const Error& error) {
    const std::string text = error.what();
    for (const char* part :
         {"/surface", "/width_px: 5", "16..8192", "/tilt_x_um_per_px", "/sead", "did you mean 'seed'?"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }
  }
}

}  // namespace
}  // namespace fvd::sim
