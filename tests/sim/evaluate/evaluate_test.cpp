#include "sim/evaluate/evaluate.hpp"

#include <cmath>
#include <functional>
#include <sstream>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "sim/world/gsf_reader.hpp"
#include "sim/world/surface.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

using nlohmann::json;

constexpr const char* kRecord =
    R"({"focus":{"peak":"parabola","extra_peaks":[{"peak":"nearest"}],"state_bytes_per_pixel":24.0},)"
    R"("frames":{"expected":22,"ok":21,"incomplete":0,"missing":1,"stale":0,"underrun":0},)"
    R"("steps":{"steps":21,"error_sd_um":0.02,"error_max_um":0.04,"move_median_ms":60.0},)"
    R"("times":{"prepare_ms":100.0,"scan_ms":1700.0,"finish_ms":12.0}})";

/// A result whose heights are the truth plus what `error_um` says of a point.
void write_result(const std::filesystem::path& folder, const std::function<double(int x, int y)>& error_um) {
  const Surface surface = make_surface({});
  cv::Mat heights(360, 480, CV_32F);
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 480; ++x) {
      heights.at<float>(y, x) =
          static_cast<float>((static_cast<double>(surface.height_um.at(x, y)) + error_um(x, y)) * 1e-6);
    }
  }
  cv::imwrite((folder / "height.tiff").string(), heights);
  cv::imwrite((folder / "height_nearest.tiff").string(), heights);
  test::write_text(folder / "result.json", kRecord);
}

json figures_of(const std::filesystem::path& folder) {
  std::ostringstream out;
  evaluate({}, folder, true, out);
  std::string text = out.str();
  text.pop_back();
  return json::parse(text.substr(text.rfind('\n') + 1));
}

TEST(Evaluate, FindsTheErrorsThatWerePutIn) {
  const test::ScratchDir folder;
  // Plateau B (the second strip) 0.3 um high, everything alternating by 0.4 um; one point of a plateau is a hole.
  write_result(folder.path(), [](int x, int y) {
    if (x == 60 && y == 60) return std::nan("");
    return (x >= 120 && x < 240 ? 0.3 : 0.0) + ((x + y) % 2 == 0 ? 0.4 : -0.4);
  });
  const json figures = figures_of(folder.path());
  EXPECT_NEAR(figures["ramp_rms_um"]["parabola"].get<double>(), 0.4, 1e-3);
  EXPECT_NEAR(figures["steps_um"][0].get<double>(), 50.3, 1e-3);
  EXPECT_NEAR(figures["steps_um"][1].get<double>(), 49.7, 1e-3);
  EXPECT_NEAR(figures["steps_um"][2].get<double>(), 100.0, 1e-3);
  EXPECT_LT(figures["valid_textured"].get<double>(), 1.0);
  EXPECT_GT(figures["valid_textured"].get<double>(), 0.9999);
  EXPECT_EQ(figures["valid_texture_poor"], 1.0);
  EXPECT_EQ(figures["frames_expected"], 22);
  EXPECT_EQ(figures["frames_ok"], 21);
  EXPECT_EQ(figures["scan_s"], 1.7);
}

TEST(Evaluate, RefusesResultsThatAreNone) {
  const test::ScratchDir folder;
  std::ostringstream out;
  EXPECT_THROW(evaluate({}, folder.path(), true, out), Error);
  write_result(folder.path(), [](int, int) { return 0.0; });
  EXPECT_NO_THROW(evaluate({}, folder.path(), true, out));
  test::write_text(folder.path() / "result.json", "{}");
  EXPECT_THROW(evaluate({}, folder.path(), true, out), Error);
  test::write_text(folder.path() / "result.json", kRecord);
  cv::imwrite((folder.path() / "height.tiff").string(), cv::Mat(10, 10, CV_32F));
  EXPECT_THROW(evaluate({}, folder.path(), true, out), Error);
}

TEST(Evaluate, HasNoFiguresWhereAWorldHasNoInterior) {
  const test::ScratchDir folder;
  write_result(folder.path(), [](int, int) { return 0.0; });
  WorldParameters world;
  world.surface = SurfaceKind::kCrossGrid;
  world.artefacts.cross_grid = {.pitch_x_um = 20.0, .pitch_y_um = 20.0, .line_width_um = 10.0};
  std::ostringstream out;

  evaluate(world, folder.path(), true, out);

  EXPECT_NE(out.str().find("\"rms_um\":null,\"bias_um\":null"), std::string::npos) << out.str();
}

TEST(Truth, IsReadBackAsTheSurface) {
  const test::ScratchDir folder;
  write_truth({}, folder.path());
  const auto heights = read_gsf_um(folder.path() / "truth.gsf");
  const Surface surface = make_surface({});
  for (std::size_t i = 0; i < heights.pixels().size(); i += 97) {
    EXPECT_NEAR(heights.pixels()[i], surface.height_um.pixels()[i], 1e-3F);
  }
}

}  // namespace
}  // namespace fvd::sim
