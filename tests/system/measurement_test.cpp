/// A PLC's trigger through JSON-RPC, Modbus and GigE Vision to the result files, against the truth.

#include <algorithm>
#include <cstring>
#include <sstream>

#include "core/focus/streaming_focus_stack.hpp"
#include "daemon/ctl/process_stack.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "sim/evaluate/evaluate.hpp"
#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

/// The figures of a result directory, as the demo prints them.
json figures_of(const std::filesystem::path& directory) {
  std::ostringstream out;
  sim::evaluate(sim::WorldParameters{}, directory, true, out);
  std::string text = out.str();
  text.pop_back();
  return json::parse(text.substr(text.rfind('\n') + 1));
}

void expect_chapter_figures(const json& figures) {
  EXPECT_NEAR(figures["plateau_rms_um"]["nearest"].get<double>(), 3.00, 0.05);
  EXPECT_LE(figures["plateau_rms_um"]["parabola"].get<double>(), 0.65);
  EXPECT_LE(figures["plateau_rms_um"]["log_parabola"].get<double>(), 0.40);
  EXPECT_LE(figures["ramp_rms_um"]["log_parabola"].get<double>(), 0.40);
  // The default of recipes: both sides, so that a gain is noticed and written down too.
  EXPECT_NEAR(figures["plateau_rms_um"]["five_sample"].get<double>(), 0.192, 0.25 * 0.192);
  EXPECT_NEAR(figures["ramp_rms_um"]["five_sample"].get<double>(), 0.231, 0.25 * 0.231);
  EXPECT_NEAR(figures["steps_um"][0].get<double>(), 50.0, 0.1);
  EXPECT_NEAR(figures["steps_um"][1].get<double>(), 50.0, 0.1);
  EXPECT_NEAR(figures["steps_um"][2].get<double>(), 100.0, 0.1);
  EXPECT_GE(figures["valid_textured"].get<double>(), 0.999);
  EXPECT_LE(figures["valid_texture_poor"].get<double>(), 0.30);
}

TEST_F(AMicroscope, MeasuresTheChaptersSurface) {
  start();
  const json started = begin(1);
  EXPECT_EQ(started["duplicate"], false) << started.dump();
  const json ended = await_end(1);
  ASSERT_EQ(ended["state"], "completed") << ended.dump();
  EXPECT_EQ(ended["frames_expected"], 21);
  EXPECT_EQ(ended["frames_ok"], 21);
  const json figures = figures_of(result_dir(1));
  expect_chapter_figures(figures);
  EXPECT_EQ(figures["frames_ok"], 21);
  await_files(1);
  for (const char* file : {"height.tiff", "height_nearest.tiff", "height_parabola.tiff", "height.gsf", "mask.png",
                           "texture.png", "preview.png", "step_log.csv", "result.json"}) {
    EXPECT_GT(std::filesystem::file_size(result_dir(1) / file), 100U) << file;
  }
  const json record = json::parse(test::read_text(result_dir(1) / "result.json"));
  EXPECT_EQ(record["provenance"]["simulated"], true);
  EXPECT_LE(record["steps"]["error_max_um"].get<double>(), 0.2);
  const json listed = ask("job.list", json::object());
  ASSERT_EQ(listed["jobs"].size(), 1U) << listed.dump();
  EXPECT_EQ(listed["jobs"][0]["job_id"], ended["job_id"]);
  EXPECT_EQ(listed["jobs"][0]["ended_utc"], ended["ended_utc"]);
  const json points = ask("value.list", {{"measurement", "map"}, {"value", "height_median"}})["points"];
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0]["value"].get<double>(), record["values"]["height"]["median_um"].get<double>(), 1e-4);
}

TEST_F(AMicroscope, MeasuresAsWellWithAControllerThatSpeaksGcs) {
  sim::PlantOptions with_gcs = options();
  with_gcs.gcs = true;
  start(with_gcs);
  begin(1);
  const json ended = await_end(1);
  ASSERT_EQ(ended["state"], "completed") << ended.dump();
  expect_chapter_figures(figures_of(result_dir(1)));
}

TEST_F(AMicroscope, BinsTheSecondScanOfAFineStepByTheWidthThatTheFirstTold) {
  const test::ScratchDir recipes;
  test::write_text(recipes.path() / "fine.json", R"({"format": 2, "acquire": {"scan": {"start_um": -20, "step_um": 4,
      "slices": 30}, "camera": {"exposure_us": 2000, "width_px": 160, "height_px": 360}}})");
  start();
  app_.reset();
  config_.paths.recipe_dir = recipes.path();
  app_ = std::make_unique<App>(config_);
  ASSERT_TRUE(wait_until_ready());
  const auto focus_of = [this](int seq, std::vector<std::string>& warnings) {
    begin(seq, "fine");
    EXPECT_EQ(await_end(seq)["state"], "completed");
    const json record = json::parse(test::read_text(result_dir(seq) / "result.json"));
    for (const json& warning : record["warnings"]) warnings.push_back(warning["code"]);
    return record["focus"];
  };
  std::vector<std::string> first_warnings;
  const json first = focus_of(1, first_warnings);
  EXPECT_EQ(first["bins_by"], "unknown_width");
  EXPECT_EQ(first["bin_slices"], 1);
  EXPECT_EQ(std::count(first_warnings.begin(), first_warnings.end(), "bins_unknown"), 1);
  std::vector<std::string> second_warnings;
  const json second = focus_of(2, second_warnings);
  EXPECT_EQ(second["bins_by"], "earlier_scans");
  EXPECT_EQ(second["bin_slices"], choose_bin_slices(4.0, first["curve_width_um"].get<double>(), 30));
  EXPECT_GT(second["bin_slices"], 1);
  EXPECT_EQ(std::count(second_warnings.begin(), second_warnings.end(), "bins_unknown"), 0);
}

TEST_F(AMicroscope, AnswersARepeatedTriggerWithTheSameJobAndNoSecondMotion) {
  start();
  const json first = begin(7);
  const json again = begin(7);
  EXPECT_EQ(again["duplicate"], true);
  EXPECT_EQ(again["job_id"], first["job_id"]);
  EXPECT_EQ(begin(8)["code"], 1002) << "one job at a time";
  await_end(7);
  const int moves = plant_->drive().moves();
  EXPECT_EQ(begin(7)["job_id"], first["job_id"]);
  EXPECT_EQ(ask("job.start", {{"seq", 7}, {"part_id", "another"}, {"recipe", "chapter"}})["code"], 1009);
  EXPECT_EQ(plant_->drive().moves(), moves);
  EXPECT_EQ(ask("result.next", json::object())["seq"], 7);
  EXPECT_EQ(ask("result.ack", {{"seq", 7}})["remaining"], 0);
}

TEST_F(AMicroscope, MeasuresRightUnderPacketLoss) {
  start();
  plant_->camera().set_packet_loss(0.01);
  begin(1);
  const json ended = await_end(1);
  ASSERT_EQ(ended["state"], "completed") << ended.dump();
  EXPECT_EQ(ended["frames_ok"], 21);
  EXPECT_GT(plant_->camera().packets_lost(), 0U);
  expect_chapter_figures(figures_of(result_dir(1)));
}

TEST_F(AMicroscope, RetriesLostFramesAndAccountsForThem) {
  start();
  begin(1);
  await_slices(1, 3);
  plant_->camera().faults().add({.fault = sim::CameraFault::kDropFrame});
  plant_->camera().faults().add({.fault = sim::CameraFault::kIgnoreTrigger});
  const json ended = await_end(1);
  ASSERT_EQ(ended["state"], "completed") << ended.dump();
  EXPECT_EQ(ended["frames_ok"], 21);
  EXPECT_EQ(ended["frames_expected"], 23);
  const json frames = json::parse(test::read_text(result_dir(1) / "result.json"))["frames"];
  EXPECT_EQ(frames["missing"], 2) << frames.dump();
}

TEST_F(AMicroscope, GivesBitForBitTheMapThatOfflineProcessingGives) {
  start();
  begin(1, "chapter-recorded");
  ASSERT_EQ(await_end(1)["state"], "completed");
  const auto live = result_dir(1);
  ctl::ProcessOptions offline;
  offline.source = live / "slices";
  offline.slices = find_slices(offline.source);
  offline.out = folder_.path() / "offline";
  offline.z = ZFile{live / "slices" / "z.txt", LengthUnit::kMicrometre};
  offline.recipe =
      parse_recipe(test::read_text(std::filesystem::path(FVD_SOURCE_DIR) / "config/recipes/chapter-recorded.json"),
                   "chapter-recorded");
  (void)ctl::process_stack(offline, {});
  await_files(1);
  for (const char* file : {"mask.png", "texture.png"}) {
    EXPECT_EQ(test::read_text(live / file), test::read_text(offline.out / file)) << file;
  }
  // The title differs; the heights are what follows the header's padding.
  const auto heights = [](const std::filesystem::path& directory) {
    const std::string text = test::read_text(directory / "height.gsf");
    return text.substr(text.size() - 480 * 360 * sizeof(float));
  };
  EXPECT_EQ(heights(live), heights(offline.out));
}

TEST_F(AMicroscope, MeasuresOnAWornAxisWithoutMoreThanItsErrors) {
  sim::PlantOptions worn = options();
  worn.axis = {.encoder_resolution_um = 0.1,
               .encoder_noise_um = 0.02,
               .settle_noise_um = 0.05,
               .ring_amplitude_um = 0.4,
               .backlash_um = 1.2,
               .lead_error_um = 0.3,
               .drift_um_per_min = 0.5,
               .start_latency_ms = 3.0};
  start(worn);
  begin(1);
  ASSERT_EQ(await_end(1)["state"], "completed");
  const json figures = figures_of(result_dir(1));
  EXPECT_LE(figures["plateau_rms_um"]["log_parabola"].get<double>(), 0.40 + 0.3 + 0.1);
}

}  // namespace
}  // namespace fvd
