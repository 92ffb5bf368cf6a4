/// Images, exposure and focus between the jobs of a line.

#include <thread>

#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

TEST_F(AMicroscope, TakesASnapAndTellsItsGreyLevels) {
  start();
  const json snap = ask("camera.snap", {{"exposure_us", 2000}});
  ASSERT_TRUE(snap.contains("path")) << snap.dump();
  EXPECT_EQ(snap["width_px"], 480);
  EXPECT_EQ(snap["height_px"], 360);
  EXPECT_EQ(snap["exposure_us"], 2000.0);
  EXPECT_LT(snap["grey"]["p01"], snap["grey"]["p50"]);
  EXPECT_LT(snap["grey"]["p50"], snap["grey"]["p99"]);
  EXPECT_EQ(test::read_text(snap["path"].get<std::string>()).substr(1, 3), "PNG");
  const json other = ask("camera.snap", {{"exposure_us", 2000}});
  EXPECT_NE(other["path"], snap["path"]);
  EXPECT_EQ(ask("camera.snap", {{"exposure_us", -1}})["code"], -32602)
      << "what no camera takes is refused with its range";
}

TEST_F(AMicroscope, FindsTheFocusOfTheMiddleAndStopsThere) {
  start();
  const json unhomed = ask("stage.autofocus", {{"from_um", -50}, {"to_um", 200}});
  EXPECT_EQ(unhomed["code"], 1113) << unhomed.dump();
  EXPECT_EQ(ask("stage.home", json::object())["homed"], true);
  const json found = ask("stage.autofocus", {{"from_um", -50}, {"to_um", 200}, {"exposure_us", 2000}});
  ASSERT_TRUE(found.contains("z_um")) << found.dump();
  // The middle half of the scene is the plateau at 50 um, with parts of its neighbours.
  EXPECT_GT(found["z_um"], -15.0);
  EXPECT_LT(found["z_um"], 115.0);
  EXPECT_NEAR(plant_->axis().true_position_um(HostClock::now()), found["z_um"].get<double>(), 1.0);
  const json sharp = ask("camera.preview", {{"exposure_us", 2000}});
  ask("stage.move", {{"z_um", 190}});
  const json blurred = ask("camera.preview", {{"exposure_us", 2000}});
  EXPECT_GT(sharp["focus"].get<double>(), 1.2 * blurred["focus"].get<double>());
  EXPECT_NEAR(blurred["z_um"].get<double>(), 190.0, 0.6);
  EXPECT_EQ(ask("stage.move", {{"z_um", 5000}})["code"], 1112) << "limits hold";
  EXPECT_EQ(ask("stage.autofocus", {{"from_um", 200}, {"to_um", 320}})["data"]["error"], "focus_range_insufficient");
}

TEST_F(AMicroscope, ShowsSlicesOfAJobWithoutDisturbingIt) {
  start();
  begin(1);
  await_slices(1, 2);
  int pictures = 0;
  std::uint64_t last = 0;
  for (;;) {
    const json status = ask("job.status", {{"seq", 1}});
    if (status.value("done", false)) break;
    const json picture = ask("camera.preview", json::object());
    if (!picture.contains("seq") || !picture.contains("png_base64")) continue;
    EXPECT_GE(picture["seq"].get<std::uint64_t>(), last);
    last = picture["seq"].get<std::uint64_t>();
    ++pictures;
  }
  EXPECT_GT(pictures, 0);
  const json ended = await_end(1);
  EXPECT_EQ(ended["state"], "completed");
  EXPECT_EQ(ended["frames_expected"], 21) << "nothing was triggered for the viewer";
  EXPECT_EQ(ended["frames_ok"], 21);
}

TEST_F(AMicroscope, StopsACommandForAJob) {
  start();
  ask("stage.home", json::object());
  LineClient focusing(app_->rpc_port());
  focusing.send(json{{"jsonrpc", "2.0"},
                     {"id", 1},
                     {"method", "stage.autofocus"},
                     {"params", {{"from_um", -400}, {"to_um", 400}, {"step_um", 5}}}}
                    .dump() +
                "\n");
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!plant_->axis().moving(HostClock::now()) && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_EQ(ask("camera.snap", json::object())["code"], 1002) << "one command at a time";
  begin(1);
  const auto answer = focusing.line(std::chrono::seconds(10));
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(json::parse(*answer)["error"]["data"]["error"], "aborted") << *answer;
  EXPECT_EQ(await_end(1)["state"], "completed");
}

TEST_F(AMicroscope, SeeksAnExposure) {
  start();
  const json found = ask("camera.suggest_exposure", {{"exposure_us", 2000}, {"target", 0.7}});
  ASSERT_TRUE(found.contains("exposure_us")) << found.dump();
  EXPECT_GE(found["looks"], 1);
  EXPECT_EQ(ask("camera.suggest_exposure", {{"target", 2}})["code"], -32602);
}

}  // namespace
}  // namespace fvd
