/// The configuration that a setup writes: checked, whole, and never over another one unasked.

#include "daemon/setup/setup_files.hpp"

#include <nlohmann/json.hpp>

#include "daemon/config/config_file.hpp"
#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::read_text;
using test::write_text;

SetupDraft decided() {
  SetupDraft draft;
  draft.devices.camera.address = "192.168.10.20";
  draft.devices.camera.mirror_y = true;
  draft.devices.stage.profile = FVD_SOURCE_DIR "/config/drives/oriental-az.json";
  draft.devices.stage.address = "192.168.20.30";
  draft.devices.stage.min = Micrometers{-80.0};
  draft.devices.stage.max = Micrometers{300.0};
  draft.devices.stage.reversed = true;
  draft.picture.exposure_us = 1234.0;
  draft.pixel_pitch_um = 0.5;
  draft.trial = TrialRange{0.0, 5.0, 21};
  return draft;
}

TEST(TheFilesOfASetup, AreAcceptedAsTheyStand) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.json";
  (void)write_setup(decided(), file, false);
  const LoadedConfig loaded = load_config(file);
  EXPECT_TRUE(loaded.problems.empty()) << to_text(loaded.problems, "fvd.json");
  EXPECT_TRUE(loaded.config.stage.reversed);
  EXPECT_TRUE(loaded.config.camera.mirror_y);
  EXPECT_EQ(loaded.config.stage.min, Micrometers{-80.0});
  EXPECT_EQ(folder.entries(), (std::set<std::string>{"fvd.json", "recipes"})) << "nothing is left over";
  const auto recipe = nlohmann::json::parse(read_text(folder / "recipes/first.json"));
  EXPECT_EQ(recipe["acquire"]["camera"]["exposure_us"], 1234.0);
  EXPECT_EQ(recipe["reconstruct"]["lateral"]["pixel_pitch_x_um"], 0.5);
}

TEST(TheFilesOfASetup, ReplaceNoFileUnasked) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.json";
  write_text(file, "{ }");
  test::expect_error(ErrorCode::kBadInput, {"is there already", "replace"},
                     [&] { (void)write_setup(decided(), file, false); });
  EXPECT_EQ(read_text(file), "{ }");
  EXPECT_EQ(folder.entries(), std::set<std::string>{"fvd.json"});
}

TEST(TheFilesOfASetup, KeepTheOlderOnesAndWhatNobodyWasAskedAbout) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.json";
  const std::string before =
      "{ \"rpc\": { \"port\": 7499 }, // the line's\n  \"camera\": { \"frame_margin_ms\": 500 } }";
  write_text(file, before);
  SetupDraft draft = decided();
  draft.devices.camera.frame_margin_ms = older_devices(file).camera.frame_margin_ms;
  (void)write_setup(draft, file, true);
  EXPECT_EQ(read_text(folder / "fvd.json.old-1"), before);
  const LoadedConfig loaded = load_config(file);
  EXPECT_EQ(loaded.config.rpc.port, 7499);
  EXPECT_EQ(loaded.config.camera.frame_margin_ms, 500);
  EXPECT_EQ(loaded.config.camera.address, "192.168.10.20");
  (void)write_setup(draft, file, true);
  EXPECT_EQ(folder.entries(), (std::set<std::string>{"fvd.json", "fvd.json.old-1", "fvd.json.old-2", "recipes"}));
  EXPECT_TRUE(std::filesystem::exists(folder / "recipes/first-2.json")) << "a recipe is not replaced either";
}

TEST(TheFilesOfASetup, LeaveNothingOverThatTheTrialDidNotSee) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.json";
  write_text(
      file,
      R"({"camera": {"serial": "old", "simulated": true, "packet_socket": false, "silence_ms": 2000, "frame_margin_ms": 500},
                       "stage": {"simulated": true, "take_up_um": 70, "speed_um_per_s": 9, "unit": 4}})");
  SetupDraft draft = decided();
  draft.devices.camera.serial = "new";
  draft.devices.camera.silence_ms = 3000;
  (void)write_setup(draft, file, true);
  const LoadedConfig loaded = load_config(file);
  EXPECT_TRUE(loaded.problems.empty()) << to_text(loaded.problems, "fvd.json");
  EXPECT_EQ(loaded.config.camera, draft.devices.camera);
  EXPECT_EQ(loaded.config.stage, draft.devices.stage);
}

TEST(TheFilesOfASetup, BeginWithWhatNobodyIsAskedAbout) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.json";
  EXPECT_EQ(older_devices(file).stage, StageConfig());
  write_text(file, R"({"stage": {"take_up_um": 70, "profile": "drive.json"}})");
  EXPECT_EQ(older_devices(file).stage.take_up, Micrometers{70.0});
  EXPECT_EQ(older_devices(file).stage.profile, folder / "drive.json");
  write_text(file, "no JSON");
  EXPECT_EQ(older_devices(file).stage, StageConfig());
}

TEST(TheFilesOfASetup, AreAllWrittenOrNone) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.json";
  std::filesystem::create_directory(folder / "recipes");
  std::filesystem::create_symlink("/nonexistent/recipe.json", folder / "recipes/first.json");
  write_text(file, "{ }");
  (void)write_setup(decided(), file, true);
  EXPECT_TRUE(std::filesystem::exists(folder / "recipes/first-2.json")) << "a name that leads nowhere is taken too";

  write_text(folder / "a file", "");
  const std::string older = R"({"paths": {"recipe_dir": "a file/recipes"}})";
  write_text(file, older);
  const auto before = folder.entries();
  test::expect_error(ErrorCode::kStorageWrite, {"a file", "Not a directory"},
                     [&] { (void)write_setup(decided(), file, true); });
  EXPECT_EQ(read_text(file), older);
  EXPECT_EQ(folder.entries(), before);
}

TEST(TheFilesOfASetup, LeaveNoRecipeWithoutItsConfiguration) {
  const test::ScratchDir folder;
  const std::string longest =
      std::string(245, 'x') + ".json";  // the file beside it, before it takes its place, is none
  test::expect_error(ErrorCode::kStorageWrite, {".new-"},
                     [&] { (void)write_setup(decided(), folder / longest, false); });
  EXPECT_EQ(folder.entries(), std::set<std::string>{"recipes"});
  EXPECT_TRUE(std::filesystem::is_empty(folder / "recipes"));
}

TEST(TheFilesOfASetup, AreRefusedInWordsWhereverTheyCannotBe) {
  const test::ScratchDir folder;
  const auto long_name = folder / std::string(300, 'x');
  test::expect_error(ErrorCode::kStorageWrite, {"cannot look for"},
                     [&] { (void)write_setup(decided(), long_name, false); });
  for (const char* older : {R"({"camera": 5})", R"({"stage": [1]})", R"({"paths": "here"})"}) {
    const auto file = folder / "fvd.json";
    write_text(file, older);
    test::expect_error(ErrorCode::kBadConfig, {}, [&] { (void)write_setup(decided(), file, true); });
    EXPECT_EQ(read_text(file), older);
  }
}

TEST(TheFilesOfASetup, AreNotWrittenWhereTheyWouldBeRefused) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.json";
  write_text(file, R"({ "rpc": { "prot": 7499 } })");
  test::expect_error(ErrorCode::kBadConfig, {"prot"}, [&] { (void)write_setup(decided(), file, true); });
  EXPECT_EQ(folder.entries(), std::set<std::string>{"fvd.json"}) << "the older one stays alone";
  SetupDraft nowhere = decided();
  nowhere.devices.stage.profile = "/nonexistent.json";
  test::expect_error(ErrorCode::kBadConfig, {"/stage/profile"},
                     [&] { (void)write_setup(nowhere, folder / "other.json", false); });
}

}  // namespace
}  // namespace fvd
