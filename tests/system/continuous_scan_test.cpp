/// A scan in one motion against the same slices step by step (how much faster it is, tests/bench/run_camera.sh tells),
/// and scans triggered by the drive's in-position output.

#include <sstream>

#include "sim/evaluate/evaluate.hpp"
#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

class AContinuousScan : public AMicroscope {
 protected:
  /// Starts with recipes of the test's own beside those that are shipped.
  void start_with(const std::string& id, json recipe) {
    start();
    app_.reset();
    for (const auto& file : std::filesystem::directory_iterator(FVD_SOURCE_DIR "/config/recipes")) {
      std::filesystem::copy(file.path(), recipes_.path() / file.path().filename());
    }
    recipe.erase("$schema");
    test::write_text(recipes_.path() / (id + ".json"), recipe.dump());
    config_.paths.recipe_dir = recipes_.path();
    app_ = std::make_unique<App>(config_);
    ASSERT_TRUE(wait_until_ready());
  }

  /// The shipped scan in one motion, slow enough for a busy machine to render its frames.
  static json slow_motion() {
    json recipe = shipped("chapter_continuous");
    recipe["acquire"]["scan"]["speed_um_per_s"] = 60;
    recipe["acquire"]["scan"]["allowed_lost_slices"] = 30;
    return recipe;
  }

  static json shipped(const std::string& id) {
    return json::parse(test::read_text(FVD_SOURCE_DIR "/config/recipes/" + id + ".json"), nullptr, true, true);
  }

  json figures_of(std::int64_t seq) {
    std::ostringstream out;
    sim::evaluate(sim::WorldParameters{}, result_dir(seq), true, out);
    std::string text = out.str();
    text.pop_back();
    return json::parse(text.substr(text.rfind('\n') + 1));
  }

  test::ScratchDir recipes_;
};

TEST_F(AContinuousScan, MeasuresAsWellAsSteps) {
  json steps = shipped("chapter_continuous");
  steps["acquire"]["scan"] = {{"start_um", -20}, {"step_um", 2}, {"slices", 101}};
  start_with("chapter_fine", steps);
  json moves = slow_motion();
  moves.erase("$schema");
  test::write_text(recipes_.path() / "moving.json", moves.dump());
  begin(1, "moving");
  const json moving = await_end(1);
  ASSERT_EQ(moving["state"], "completed") << moving.dump();
  begin(2, "chapter_fine");
  const json stopping = await_end(2);
  ASSERT_EQ(stopping["state"], "completed") << stopping.dump();
  const json fast = json::parse(test::read_text(result_dir(1) / "result.json"));
  EXPECT_EQ(fast["slices"]["scan_mode"], "continuous");
  EXPECT_GE(fast["slices"]["measured"], 69) << "one at each end may fall out of the range";
  EXPECT_GT(fast["slices"]["ramp_frames"], 0);
  // tests/bench/run_camera.sh tells the figures of a quiet machine.
  const json of_moving = figures_of(1);
  const json of_stopping = figures_of(2);
  RecordProperty("moving", of_moving.dump());
  RecordProperty("stopping", of_stopping.dump());
  for (const char* region : {"plateau_rms_um", "ramp_rms_um"}) {
    EXPECT_LT(of_moving[region]["five_sample"].get<double>(), 2.0 * of_stopping[region]["five_sample"].get<double>())
        << region;
  }
}

TEST_F(AContinuousScan, IsRefusedWhereItWouldBlur) {
  json blurred = shipped("chapter_continuous");
  blurred["acquire"]["camera"]["exposure_us"] = 3000;
  start_with("blurred", blurred);
  const int moves = plant_->drive().moves();
  const json refused = begin(1, "blurred");
  EXPECT_EQ(refused["code"], 1006) << refused.dump();
  EXPECT_NE(refused["message"].get<std::string>().find("333.3"), std::string::npos) << "the largest speed allowed";
  EXPECT_EQ(plant_->drive().moves(), moves);
}

TEST_F(AContinuousScan, EndsWhenItsCameraIsLostAndTheNextWorks) {
  start_with("moving", slow_motion());
  begin(1, "moving");
  await_slices(1, 20);
  plant_->unplug_camera();
  const json ended = await_end(1);
  EXPECT_EQ(ended["error"], "camera_disconnected") << ended.dump();
  EXPECT_FALSE(plant_->axis().moving(HostClock::now() + std::chrono::seconds(1)));
  plant_->plug_camera();
  ASSERT_TRUE(wait_until_ready());
  begin(2, "moving");
  EXPECT_EQ(await_end(2)["state"], "completed");
}

TEST_F(AContinuousScan, StepsWithTheDriveTriggeringTheCamera) {
  json by_line = shipped("chapter");
  by_line["acquire"]["scan"]["trigger"] = "line";
  start_with("by_line", by_line);
  begin(1, "by_line");
  const json ended = await_end(1);
  ASSERT_EQ(ended["state"], "completed") << ended.dump();
  EXPECT_EQ(ended["frames_ok"], 21);
  EXPECT_LE(figures_of(1)["plateau_rms_um"]["log_parabola"].get<double>(), 0.40);
  plant_->camera().faults().add({.fault = sim::CameraFault::kDropFrame, .after = 4});
  begin(2, "by_line");
  const json again = await_end(2);
  EXPECT_EQ(again["state"], "completed") << again.dump();
  EXPECT_EQ(again["frames_ok"], 21);
}

}  // namespace
}  // namespace fvd
