/// What the line must survive: devices that vanish, jobs that are aborted, a daemon that is stopped.

#include <chrono>

#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST_F(AMicroscope, EndsTheJobWhenTheCameraDiesAndMeasuresAgainWhenItIsBack) {
  start();
  begin(1);
  await_slices(1, 5);
  plant_->unplug_camera();
  const auto died = std::chrono::steady_clock::now();
  const json ended = await_end(1);
  EXPECT_LT(seconds_since(died), 5.0);
  EXPECT_EQ(ended["state"], "failed");
  EXPECT_EQ(ended["error"], "camera_disconnected") << ended.dump();
  EXPECT_EQ(ended["error_code"], 1101);
  plant_->plug_camera();
  ASSERT_TRUE(wait_until_ready());
  EXPECT_EQ(begin(2)["seq"], 2);
  EXPECT_EQ(await_end(2)["state"], "completed");
}

TEST_F(AMicroscope, EndsTheJobWhenTheStageStopsAnsweringAndMeasuresAgainWhenItIsBack) {
  start();
  begin(1);
  await_slices(1, 5);
  plant_->stage().set_mute(true);
  const auto died = std::chrono::steady_clock::now();
  const json ended = await_end(1);
  EXPECT_LT(seconds_since(died), 5.0);
  EXPECT_EQ(ended["state"], "failed");
  EXPECT_EQ(ended["error"], "stage_disconnected") << ended.dump();
  EXPECT_EQ(ended["error_code"], 1111);
  plant_->stage().set_mute(false);
  ASSERT_TRUE(wait_until_ready());
  EXPECT_EQ(begin(2)["seq"], 2);
  EXPECT_EQ(await_end(2)["state"], "completed");
}

TEST_F(AMicroscope, ReportsAnAlarmOfTheDrive) {
  start();
  begin(1);
  await_slices(1, 5);
  plant_->drive().raise_alarm(0x30);
  const json ended = await_end(1);
  EXPECT_EQ(ended["error"], "stage_alarm") << ended.dump();
  EXPECT_NE(ended["error_message"].get<std::string>().find("overload"), std::string::npos);
  // No further part is lost to it: the machine is in error until the drive has ended the alarm.
  const json state = ask("system.state", json::object());
  EXPECT_EQ(state["state"], "error") << state.dump();
  EXPECT_EQ(state["error_code"], 1115);
  EXPECT_FALSE(state["ready"]);
  EXPECT_EQ(begin(2)["code"], 1001);
  EXPECT_TRUE(ask("error.reset", json::object()).contains("z_um"));
  EXPECT_TRUE(wait_until_ready());
  begin(3);
  EXPECT_EQ(await_end(3)["state"], "completed");
}

TEST_F(AMicroscope, StaysInErrorWithAnAlarmWhoseCauseStands) {
  start();
  plant_->drive().keep_alarms();
  plant_->drive().raise_alarm(0x30);
  EXPECT_EQ(ask("error.reset", json::object())["code"], 1115);
  EXPECT_EQ(ask("system.state", json::object())["state"], "error");
}

TEST_F(AMicroscope, AbortsAJobOnRequestAndTakesTheNext) {
  start();
  begin(1);
  await_slices(1, 3);
  ask("job.abort", {{"seq", 1}});
  const json ended = await_end(1);
  EXPECT_EQ(ended["state"], "aborted");
  EXPECT_EQ(ended["error_code"], 1012);
  EXPECT_EQ(ask("job.abort", {{"seq", 1}})["state"], "aborted") << "aborting again changes nothing";
  EXPECT_EQ(begin(2)["seq"], 2);
  EXPECT_EQ(await_end(2)["state"], "completed");
}

TEST_F(AMicroscope, RefusesWhatItCannotMeasureBeforeAnythingMoves) {
  start();
  const int moves = plant_->drive().moves();
  EXPECT_EQ(begin(1, "no-such-recipe")["code"], 1005);
  EXPECT_EQ(begin(1, "../fvd-sim")["code"], 1005);
  test::ScratchDir recipes;
  test::write_text(recipes.path() / "far.json", R"({"scan": {"start_um": 400, "step_um": 10, "slices": 21}})");
  test::write_text(recipes.path() / "broken.json",
                   R"({"scan": {"start_um": 0, "step_um": -1, "slices": 2, "stepp_um": 1}})");
  app_.reset();
  config_.paths.recipe_dir = recipes.path();
  app_ = std::make_unique<App>(config_);
  ASSERT_TRUE(wait_until_ready());
  const json far = begin(1, "far");
  EXPECT_EQ(far["code"], 1112) << far.dump();
  const json broken = begin(1, "broken");
  EXPECT_EQ(broken["code"], 1006);
  for (const char* part : {"/scan/step_um", "/scan/slices", "/scan/stepp_um"}) {
    EXPECT_NE(broken["message"].get<std::string>().find(part), std::string::npos) << broken.dump();
  }
  EXPECT_EQ(plant_->drive().moves(), moves);
}

TEST_F(AMicroscope, IsNotReadyWithoutItsDevices) {
  start();
  plant_->unplug_stage();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  json state;
  do {
    state = ask("system.state", json::object());
  } while (state["ready"] == true && std::chrono::steady_clock::now() < deadline);
  EXPECT_EQ(state["state"], "error") << state.dump();
  EXPECT_EQ(state["error"], "stage_disconnected");
  const json refused = begin(1);
  EXPECT_EQ(refused["code"], 1001);
  EXPECT_EQ(refused["data"]["retry"], true);
}

TEST_F(AMicroscope, StopsInOrderInTheMiddleOfAJobAndRemembersIt) {
  start();
  begin(1);
  await_slices(1, 3);
  const auto asked = std::chrono::steady_clock::now();
  app_.reset();
  EXPECT_LT(seconds_since(asked), 10.0);
  EXPECT_FALSE(plant_->axis().moving(HostClock::now() + std::chrono::seconds(1)));
  app_ = std::make_unique<App>(config_);
  const json job = ask("job.status", {{"seq", 1}});
  EXPECT_EQ(job["state"], "aborted") << job.dump();
  EXPECT_EQ(job["error"], "shutting_down");
  EXPECT_EQ(ask("system.ping", json::object())["epoch"], 2);
  ASSERT_TRUE(wait_until_ready());
  EXPECT_EQ(begin(1)["duplicate"], true) << "never a second motion for one seq";
}

TEST_F(AMicroscope, StopsInOrderWhileItsDevicesAreMissing) {
  start();
  plant_->unplug_camera();
  plant_->unplug_stage();
  const auto asked = std::chrono::steady_clock::now();
  app_.reset();
  EXPECT_LT(seconds_since(asked), 20.0);
}

}  // namespace
}  // namespace fvd
