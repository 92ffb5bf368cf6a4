/// fvdctl stage check and stage accuracy against simulated drives.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "drivers/common/drive_lock.hpp"
#include "gtest/gtest.h"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd::ctl {
namespace {

using nlohmann::json;
using test::Transport;

struct Ran {
  int code = 0;
  std::string out;
  std::string err;
};

Ran fvdctl(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream err;
  Ran run;
  run.code = run_fvdctl(arguments, {out, err, false});
  run.out = out.str();
  run.err = err.str();
  return run;
}

/// "stage WHAT PROFILE" and how to reach the drive.
std::vector<std::string> stage_words(const char* what, const StageConfig& config) {
  std::vector<std::string> words{"stage", what, config.profile.string()};
  if (config.transport == "rtu") {
    words.insert(words.end(), {"--serial", config.serial_device});
  } else {
    words.insert(words.end(), {"--tcp", "127.0.0.1:" + std::to_string(config.port)});
  }
  return words;
}

class StageCheck : public testing::TestWithParam<std::tuple<test::DriveCase, Transport>> {};

TEST_P(StageCheck, FindsThatTheDriveFitsItsProfileAndMovesNothing) {
  const auto& [drive, transport] = GetParam();
  test::SimulatedDrive plant(drive, transport);
  auto words = stage_words("check", plant.config());
  words.emplace_back("--json");
  const Ran run = fvdctl(words);
  EXPECT_EQ(run.code, kExitOk) << run.out << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["disagreements"], json::array());
  EXPECT_EQ(report["status"]["moving"], "no");
  EXPECT_EQ(plant.drive().moves(), 0);
}

INSTANTIATE_TEST_SUITE_P(Of, StageCheck,
                         testing::Combine(testing::ValuesIn(test::kDriveCases),
                                          testing::Values(Transport::kTcp, Transport::kRtu)),
                         [](const auto& on) {
                           return testing::PrintToString(std::get<0>(on.param)) +
                                  testing::PrintToString(std::get<1>(on.param));
                         });

TEST(StageCheckOf, ADriveWithAnotherMapNamesWhatDisagrees) {
  const test::SimulatedDrive plant(test::kDriveCases[0], Transport::kTcp);
  StageConfig config = plant.config();
  config.profile = FVD_SOURCE_DIR "/config/drives/leadshine-pr.json";
  const Ran run = fvdctl(stage_words("check", config));
  EXPECT_EQ(run.code, kExitBadData);
  EXPECT_NE(run.out.find("register 'status' at 4099 (0x1003) cannot be read: exception 2: illegal data address"),
            std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("position  unknown"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("alarm     unknown"), std::string::npos) << run.out;
}

TEST(StageCheckOf, ADriveInAlarmSaysWhich) {
  test::SimulatedDrive plant(test::kDriveCases[0], Transport::kTcp);
  plant.drive().raise_alarm(0x30);
  const Ran run = fvdctl(stage_words("check", plant.config()));
  EXPECT_EQ(run.code, kExitOk) << run.out;
  EXPECT_NE(run.out.find("alarm 0x30: overload"), std::string::npos) << run.out;
}

TEST(StageCheckOf, ALineThatCannotBeIsRefused) {
  const std::string profile = FVD_SOURCE_DIR "/config/drives/oriental-az.json";
  EXPECT_EQ(fvdctl({"stage", "check", profile}).code, kExitUsage);
  EXPECT_EQ(fvdctl({"stage", "check", profile, "--tcp", "host:99999"}).code, kExitUsage);
  EXPECT_EQ(fvdctl({"stage", "check", profile, "--tcp", "127.0.0.1:1"}).code, kExitUnavailable);
  EXPECT_EQ(fvdctl({"stage", "check", "/nonexistent.json", "--tcp", "127.0.0.1"}).code, kExitUsage);
  const Ran baud = fvdctl({"stage", "check", profile, "--serial", "/dev/null", "--baud", "12345"});
  EXPECT_NE(baud.code, kExitOk);
  EXPECT_NE(baud.err.find("12345: expected one of"), std::string::npos) << baud.err;
}

class StageAccuracy : public testing::Test {
 protected:
  Ran measure(std::vector<std::string> more) {
    auto words = stage_words("accuracy", plant_.config());
    words.insert(words.end(), {"--from-um", "0", "--to-um", "40", "--steps", "4", "--repeats", "1", "--out", out()});
    words.insert(words.end(), more.begin(), more.end());
    return fvdctl(words);
  }
  [[nodiscard]] std::string out() const { return (scratch_ / "report").string(); }

  test::ScratchDir scratch_;
  test::SimulatedDrive plant_{test::kDriveCases[0], Transport::kTcp};
};

TEST_F(StageAccuracy, WritesReportPointsAndPicture) {
  const Ran run = measure({"--home", "--simulated"});
  ASSERT_EQ(run.code, kExitOk) << run.err;
  std::ifstream in(out() + "/stage_accuracy.json");
  const json report = json::parse(in);
  EXPECT_EQ(report["provenance"]["simulated"], true);
  EXPECT_LT(report["error"]["sd_um"].get<double>(), 0.1);
  EXPECT_TRUE(std::filesystem::exists(out() + "/stage_accuracy.png"));
  std::ifstream csv(out() + "/stage_accuracy.csv");
  int lines = 0;
  for (std::string line; std::getline(csv, line);) ++lines;
  EXPECT_GE(lines, 11) << "ten points and a head";
  EXPECT_EQ(fvdctl({"stage", "accuracy"}).code, kExitUsage);
  const Ran again = measure({});
  EXPECT_NE(again.err.find("exists already"), std::string::npos) << "an old report is not overwritten";
}

TEST_F(StageAccuracy, DoesNotSayThatAStageIsRealForItCannotKnow) {
  const Ran run = measure({"--home"});
  ASSERT_EQ(run.code, kExitOk) << run.err;
  std::ifstream in(out() + "/stage_accuracy.json");
  EXPECT_FALSE(json::parse(in)["provenance"].contains("simulated"));
}

TEST_F(StageAccuracy, DoesNotHomeUnasked) {
  const Ran run = measure({});
  EXPECT_NE(run.code, kExitOk);
  EXPECT_NE(run.err.find("--home"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(StageAccuracy, MovesNothingWhereTakeUpDoesNotFit) {
  const Ran run = measure({"--home", "--max-um", "50"});
  EXPECT_NE(run.code, kExitOk);
  EXPECT_NE(run.err.find("-20..60 um"), std::string::npos) << run.err;
  EXPECT_EQ(plant_.drive().moves(), 0);
}

/// The axis of a daemon that was killed in the middle of a move, and its configuration.
class AnAbandonedStage : public testing::Test {
 protected:
  static constexpr std::int32_t kTarget_steps = 100'000;  // 1000 um, 2 s away at least

  void SetUp() override {
    (void)plant_.open_homed();  // and given up again
    plant_.axis().move_to(HostClock::now(), kTarget_steps, 50'000.0, 1e7, 1e7);
    while (!plant_.axis().moving(HostClock::now())) std::this_thread::yield();  // it starts a little later
  }
  Ran stop(const json& changes = json::object()) {
    const StageConfig stage = plant_.config();
    json config{{"camera", {{"address", "127.0.0.1"}}},
                {"stage", {{"profile", stage.profile}, {"address", "127.0.0.1"}, {"port", stage.port}}},
                {"paths", {{"recipe_dir", folder_.path().string()}}}};
    config.merge_patch(changes);
    const auto file = folder_.path() / "fvd.json";
    std::ofstream(file) << config.dump();
    return fvdctl({"stage", "stop", "--config", file.string()});
  }
  test::ScratchDir folder_;
  test::SimulatedDrive plant_{test::kDriveCases[0], Transport::kTcp};
};

TEST_F(AnAbandonedStage, IsStoppedAndSeenToStandStill) {
  const Ran run = stop();
  EXPECT_EQ(run.code, kExitOk) << run.err;
  EXPECT_NE(run.out.find("the stage stands still at "), std::string::npos) << run.out;
  const HostTime now = HostClock::now();
  EXPECT_FALSE(plant_.axis().moving(now));
  EXPECT_LT(plant_.axis().command_steps(now), kTarget_steps) << "stopped on its way";
}

TEST_F(AnAbandonedStage, IsLeftToAProgramThatHasTheDrive) {
  const DriveLock other(plant_.config());
  const Ran run = stop();
  EXPECT_NE(run.code, kExitOk);
  EXPECT_NE(run.err.find("the drive is in use by process"), std::string::npos) << run.err;
  EXPECT_TRUE(plant_.axis().moving(HostClock::now()) || plant_.axis().command_steps(HostClock::now()) == kTarget_steps);
}

TEST_F(AnAbandonedStage, IsNotTouchedWithABrokenConfiguration) {
  const Ran run = stop({{"stage", {{"port", 0}}}});
  EXPECT_EQ(run.code, kExitConfig);
  EXPECT_NE(run.err.find("/stage/port: 0 is not accepted"), std::string::npos) << run.err;
}

TEST(StageStop, HasNothingToDoForRecordedSlices) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "fvd.json";
  std::ofstream(file) << json{{"camera", {{"driver", "replay"}, {"replay_dir", folder.path().string()}}},
                              {"stage", {{"driver", "replay"}}},
                              {"paths", {{"recipe_dir", folder.path().string()}}}};
  const Ran run = fvdctl({"stage", "stop", "--config", file.string()});
  EXPECT_EQ(run.code, kExitOk) << run.err;
  EXPECT_NE(run.out.find("nothing to stop"), std::string::npos);
}

}  // namespace
}  // namespace fvd::ctl
