#include "sim/evaluate/truth_file.hpp"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "gtest/gtest.h"
#include "sim/evaluate/evaluate.hpp"
#include "sim/world/world_config.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

using nlohmann::json;

json truth_of(const WorldParameters& world) {
  const test::ScratchDir scratch;
  write_truth(world, scratch.path());
  std::ifstream in(scratch / "truth.json");
  return json::parse(in);
}

json shipped(const std::string& name) { return truth_of(load_world(FVD_SOURCE_DIR "/sim/worlds/" + name + ".json")); }

TEST(TruthFile, TellsAGroove) {
  const json truth = shipped("groove_tilted");

  EXPECT_EQ(truth.at("surface"), "groove");
  EXPECT_EQ(truth.at("width_px"), 480);
  EXPECT_EQ(truth.at("pixel_pitch_um"), 1.0);
  EXPECT_EQ(truth.at("tilt").at("slope_x"), 0.02);
  const json& groove = truth.at("groove");
  EXPECT_EQ(groove.at("depth_um"), 50.0);
  EXPECT_NEAR(groove.at("depth_perpendicular_um").get<double>(), 50.0 / std::sqrt(1.0005), 1e-12);
  EXPECT_EQ(groove.at("width_um"), 90.0);
  EXPECT_EQ(groove.at("wall_angle_deg"), 80.0);
  EXPECT_EQ(groove.at("direction_deg"), 90.0);
  EXPECT_EQ(groove.at("centre_um"), (json{240.0, 180.0}));
}

TEST(TruthFile, TellsAnEdge) {
  const json edge = shipped("edge_k2").at("edge");
  EXPECT_EQ(edge.at("K"), 2.0);
  EXPECT_EQ(edge.at("S_gamma_um"), 40.0);
  EXPECT_EQ(edge.at("S_alpha_um"), 20.0);
  EXPECT_EQ(edge.at("beta_deg"), 90.0);
  EXPECT_TRUE(edge.at("radius_um").is_null());
  EXPECT_NEAR(edge.at("Delta_r_um").get<double>(), 2.0 * 5.577801, 1e-6);
  EXPECT_EQ(edge.at("rake_side"), "bottom");

  EXPECT_EQ(shipped("edge_k05").at("edge").at("K"), 0.5);
  EXPECT_EQ(shipped("edge_90deg").at("edge").at("rake_side"), "left");
  EXPECT_NEAR(shipped("edge_r5").at("edge").at("S_gamma_um").get<double>(), 5.0, 1e-12);
  EXPECT_EQ(shipped("edge_sharp").at("edge").at("radius_um"), 0.0);
  EXPECT_TRUE(shipped("edge_sharp").at("edge").at("K").is_null());
  EXPECT_EQ(shipped("edge_17deg").at("edge").at("direction_deg"), 17.0);
}

TEST(TruthFile, ListsNotchesAndPolishedRegions) {
  const json notches = shipped("edge_notched").at("edge").at("notches");
  ASSERT_EQ(notches.size(), 5U);
  EXPECT_EQ(notches[1].at("position_um"), -90.0);
  EXPECT_EQ(notches[1].at("at_um"), (json{150.0, 180.0}));
  EXPECT_EQ(notches[1].at("width_um"), 30.0);
  EXPECT_EQ(notches[1].at("depth_um"), 8.0);
  EXPECT_EQ(notches[1].at("area_um2"), 240.0);

  const json regions = shipped("edge_polished").at("contrast_regions");
  ASSERT_EQ(regions.size(), 1U);
  EXPECT_EQ(regions[0].at("contrast_percent"), 3.0);
  EXPECT_EQ(regions[0].at("polygon_um")[0], (json{180.0, 180.0}));
  EXPECT_EQ(regions[0].at("polygon_um")[1], (json{300.0, 180.0}));
}

TEST(TruthFile, TellsTheOtherArtefacts) {
  const json stairs = shipped("stairs").at("stairs");
  EXPECT_EQ(stairs.at("steps")[2].at("height_um"), 50.0);
  EXPECT_EQ(stairs.at("treads")[1].at("centre_um"), (json{180.0, 180.0}));
  const json sinusoid = shipped("sinusoid").at("sinusoid");
  EXPECT_NEAR(sinusoid.at("Sa_um").get<double>(), 3.183099, 1e-6);
  EXPECT_NEAR(sinusoid.at("Sq_um").get<double>(), 3.535534, 1e-6);
  EXPECT_NEAR(shipped("star").at("star").at("sector_width_per_radius").get<double>(), 0.1745329, 1e-7);
  EXPECT_EQ(shipped("cross_grid").at("cross_grid").at("pitch_x_um"), 60.0);
  EXPECT_EQ(shipped("letter_f").at("letter_f").at("rectangles_um")[2].at("y"), 155.0);
  EXPECT_EQ(shipped("sphere").at("sphere").at("radius_um"), 500.0);
  EXPECT_EQ(shipped("rough").at("rough").at("Sq_um"), 5.0);
  EXPECT_EQ(shipped("tilted").at("tilted").at("slope_x"), 0.25);
  EXPECT_TRUE(shipped("flat").at("flat").is_null());
  EXPECT_EQ(shipped("chapter").at("surface"), "chapter");
}

TEST(TruthFile, LiesBesideHeightsInTheirScale) {
  const test::ScratchDir scratch;
  WorldParameters world;
  world.surface = SurfaceKind::kFlat;
  world.pixel_pitch_um = 0.5;

  write_truth(world, scratch.path());

  std::ifstream in(scratch / "truth.gsf", std::ios::binary);
  std::string header(200, '\0');
  in.read(header.data(), 200);
  EXPECT_NE(header.find("\nXReal = 0.00024\nYReal = 0.00018\nXYUnits = m\n"), std::string::npos) << header;
}

TEST(TruthFile, SaysIfItCannotBeWritten) {
  const test::ScratchDir scratch;
  test::expect_error(ErrorCode::kStorageWrite, {"truth.json"},
                     [&] { write_truth_file(WorldParameters{}, scratch / "absent"); });
}

}  // namespace
}  // namespace fvd::sim
