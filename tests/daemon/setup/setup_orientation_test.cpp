/// Every way in which axis and camera can be built ends in a configuration under which heights and pictures are
/// upright.

#include "daemon/config/config_file.hpp"
#include "gtest/gtest.h"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/set_up_station.hpp"

namespace fvd {
namespace {

class AStation : public testing::TestWithParam<test::Built> {};

TEST_P(AStation, IsSetUpTheRightWayRound) {
  sim::Plant plant(test::letter_f_station(GetParam()));
  test::ScratchDir folder;
  const SetupOptions options{folder / "fvd.json", FVD_SOURCE_DIR "/config/drives", folder.path(), true, {}};
  const test::SetUp result = test::set_up(plant, options, FVD_SOURCE_DIR "/config/drives/oriental-az.json");
  ASSERT_TRUE(result.done) << result.log;
  EXPECT_EQ(result.unattended_moves, 0) << result.log;

  const LoadedConfig loaded = load_config(result.written);
  EXPECT_TRUE(loaded.problems.empty()) << to_text(loaded.problems, "fvd.json");
  EXPECT_EQ(loaded.config.stage.reversed, GetParam().reversed) << result.log;
  EXPECT_EQ(loaded.config.camera.mirror_x, GetParam().mirror.x) << result.log;
  EXPECT_EQ(loaded.config.camera.mirror_y, GetParam().mirror.y) << result.log;
  EXPECT_EQ(loaded.config.stage.min, Micrometers{-50.0});
  EXPECT_NEAR(loaded.config.stage.max.value, 210.0, 20.0);
  EXPECT_TRUE(std::filesystem::exists(folder / "recipes/first.json")) << result.log;
}

INSTANTIATE_TEST_SUITE_P(Built, AStation, testing::ValuesIn(test::all_ways_to_build()), [](const auto& on) {
  const test::Built& built = on.param;
  return std::string(built.reversed ? "Reversed" : "Straight") + (built.mirror.x ? "MirroredX" : "") +
         (built.mirror.y ? "MirroredY" : "");
});

TEST(AStationWhoseDriveForgetsItsReference, IsHomedAgainAndSetUpAllTheSame) {
  sim::PlantOptions built = test::letter_f_station({true, {true, false}});
  built.drive = sim::DriveKind::kCia402;
  sim::Plant plant(built);
  test::ScratchDir folder;
  const SetupOptions options{folder / "fvd.json", FVD_SOURCE_DIR "/config/drives", folder.path(), true, {}};
  const test::SetUp result = test::set_up(plant, options, FVD_SOURCE_DIR "/config/drives/nanotec-cia402.json");
  ASSERT_TRUE(result.done) << result.log;
  EXPECT_EQ(result.unattended_moves, 0) << result.log;
  EXPECT_TRUE(load_config(result.written).config.stage.reversed) << result.log;
}

}  // namespace
}  // namespace fvd
