/// Several scans in one job, through the whole path.

#include <algorithm>
#include <cmath>

#include "daemon/surface_files/surface_files.hpp"
#include "tests/system/system_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

/// A part of the reference scene's plateaus, with or without repetition.
std::string recipe_text(int repeat) {
  return R"({"format": 2, "acquire": {"scan": {"start_um": -7, "step_um": 10, "slices": 21}, "repeat": )" +
         std::to_string(repeat) +
         R"(, "camera": {"exposure_us": 5000, "width_px": 160, "height_px": 360}}, "export": ["tiff", "repeat_sd.tiff", "repeat_sd.gsf"]})";
}

/// The noise of one of two maps: root mean square of their difference, about its mean, over sqrt 2.
double noise_um(const Surface& a, const Surface& b) {
  double sum = 0.0;
  double squares = 0.0;
  int points = 0;
  for (std::size_t i = 0; i < a.height_m.pixels().size(); ++i) {
    const double difference_um =
        1e6 * (static_cast<double>(a.height_m.pixels()[i]) - static_cast<double>(b.height_m.pixels()[i]));
    if (std::isnan(difference_um)) continue;
    sum += difference_um;
    squares += difference_um * difference_um;
    ++points;
  }
  EXPECT_GT(points, 10000);
  const double mean = sum / points;
  return std::sqrt((squares / points - mean * mean) / 2.0);
}

double rms_um(const Surface& sigma) {
  double squares = 0.0;
  int points = 0;
  for (const float value_m : sigma.height_m.pixels()) {
    if (std::isnan(value_m)) continue;
    squares += 1e12 * static_cast<double>(value_m) * static_cast<double>(value_m);
    ++points;
  }
  return std::sqrt(squares / std::max(points, 1));
}

TEST_F(AMicroscope, HalvesTheNoiseByFourScansOfOneJob) {
  const test::ScratchDir recipes;
  test::write_text(recipes.path() / "one.json", recipe_text(1));
  test::write_text(recipes.path() / "four.json", recipe_text(4));
  start();
  app_.reset();
  config_.paths.recipe_dir = recipes.path();
  app_ = std::make_unique<App>(config_);
  ASSERT_TRUE(wait_until_ready());
  std::vector<Surface> maps;
  std::vector<std::filesystem::path> folders;
  for (const char* recipe : {"one", "one", "four", "four"}) {
    const auto seq = static_cast<std::int64_t>(maps.size()) + 1;
    begin(seq, recipe);
    const json ended = await_end(seq);
    ASSERT_EQ(ended["state"], "completed") << ended.dump();
    const int scans = seq > 2 ? 4 : 1;
    EXPECT_EQ(ended["slices_planned"], 21 * scans);
    EXPECT_EQ(ended["slices_done"], 21 * scans);
    EXPECT_EQ(ended["frames_ok"], 21 * scans);
    EXPECT_EQ(ended["acquired"], true);
    folders.push_back(result_dir(seq));
    maps.push_back(read_surface(folders.back() / "height.tiff", {.pitch_x_um = 1.0, .pitch_y_um = 1.0}));
  }

  const double of_one = noise_um(maps[0], maps[1]);
  const double of_four = noise_um(maps[2], maps[3]);
  RecordProperty("noise_ratio", std::to_string(of_one / of_four));
  EXPECT_GT(of_one / of_four, 1.6) << of_one << " and " << of_four;
  EXPECT_LT(of_one / of_four, 2.4) << of_one << " and " << of_four;

  const json record = json::parse(test::read_text(folders[3] / "result.json"));
  EXPECT_EQ(record["repeat"]["scans"], 4);
  const double sd_um = record["repeat"]["sd_rms_um"].get<double>();
  EXPECT_NEAR(sd_um / of_one, 1.0, 0.4);
  const double predicted_um = 2.0 * rms_um(read_surface(folders[3] / "sigma.tiff", {1.0, 1.0}));  // of single scans
  RecordProperty("noise_of_one_um", std::to_string(of_one));
  RecordProperty("sd_rms_um", std::to_string(sd_um));
  RecordProperty("sigma_of_one_um", std::to_string(predicted_um));
  EXPECT_GT(sd_um / predicted_um, 0.5) << "the scatter is what the curves say of themselves";
  EXPECT_LT(sd_um / predicted_um, 2.0);
  EXPECT_EQ(record["slices"]["planned"], 84);
  EXPECT_EQ(record["slices"]["measured"], 84);
  EXPECT_TRUE(std::filesystem::exists(folders[3] / "repeat_sd.gsf"));
  EXPECT_FALSE(std::filesystem::exists(folders[0] / "repeat_sd.tiff"));
  EXPECT_FALSE(json::parse(test::read_text(folders[0] / "result.json")).contains("repeat"));
}

}  // namespace
}  // namespace fvd
