/// From scans of a groove by the simulated microscope to constants that are in force, by fvdctl and by the API.

#include "sim/world/world_config.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

class ACalibratedMicroscope : public AMicroscope {
 protected:
  test::Outcome fvdctl(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--address", "127.0.0.1:" + std::to_string(app_->rpc_port())});
    return test::run_command(arguments);
  }
  json fvdctl_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const test::Outcome outcome = fvdctl(std::move(arguments));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(ACalibratedMicroscope, FindsThePlantedAmplificationAndPutsItInForce) {
  constexpr double kScaleError = 0.004;  // true motion over what the encoder tells, minus 1
  sim::PlantOptions with = options();
  with.world = sim::load_world(FVD_SOURCE_DIR "/sim/worlds/groove_50.json");
  with.axis.scale_error = kScaleError;
  ASSERT_NO_FATAL_FAILURE(start(with));

  const json noise = fvdctl_json({"verify", "noise", "--scans", "2", "--recipe", "groove", "--part", "normal-50"});

  ASSERT_EQ(noise["study"]["jobs"].size(), 2U) << noise.dump();
  EXPECT_EQ(noise["study"]["simulated"], true);
  std::vector<std::string> command{"calibrate", "z", "--person", "anna"};
  for (const json& job : noise["study"]["jobs"]) {
    command.insert(command.end(), {"--step", job.get<std::string>() + "=50,0.005"});
  }
  const json found = fvdctl_json(command);
  const json alpha = found["study"]["figures"][0];
  ASSERT_EQ(alpha["name"], "alpha_z");
  EXPECT_NEAR(alpha["value"].get<double>(), 1.0 / (1.0 + kScaleError), 0.001) << found.dump();
  EXPECT_GT(alpha["u"].get<double>(), 0.0001) << "the certificate's part alone";
  EXPECT_EQ(ask("calibration.get", json::object())["code"], 1143);
  EXPECT_TRUE(std::filesystem::exists(found["report"].get<std::string>()));

  const std::string study = found["study"]["id"];
  const test::Outcome accepted = fvdctl(
      {"calibrate", "accept", study, "--person", "anna", "--certificate", "DKD-4711", "--renew-by", "2099-12-31"});

  EXPECT_EQ(accepted.code, 0) << accepted.err;
  EXPECT_EQ(accepted.out, "cal-0001 is in force now\n");
  EXPECT_EQ(fvdctl({"calibrate", "accept", study, "--person", "anna", "--renew-by", "2099-12-31"}).out,
            "cal-0001 had been made of it already\n");
  const json calibration = ask("calibration.get", json::object())["calibration"];
  EXPECT_EQ(calibration["z"]["alpha_z"], alpha["value"]);
  EXPECT_EQ(calibration["z"]["origin"]["study"], study);
  EXPECT_EQ(fvdctl({"calibrate", "accept", noise["study"]["id"], "--person", "anna", "--renew-by", "2099-12-31"}).code,
            65);
  EXPECT_EQ(fvdctl({"verify", "noise", "nobody", "nothing"}).code, 65);
  EXPECT_EQ(fvdctl({"gauge", "rr", "--parts", "2", "--operators", "1", "--trials", "2"}).code, 64);
  const test::Outcome list = fvdctl({"study", "list"});
  EXPECT_NE(list.out.find("accepted as cal-0001"), std::string::npos) << list.out;
  EXPECT_NE(fvdctl({"study", "get", study}).out.find("alpha_z"), std::string::npos);
}

}  // namespace
}  // namespace fvd
