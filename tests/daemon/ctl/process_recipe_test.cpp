#include <cmath>
#include <cstring>
#include <optional>
#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"

namespace fvd::ctl {
namespace {

using test::process;
using test::read_float;
using test::ScratchDir;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// For slices of write_stack().
constexpr const char* kRecipe = R"({
  "scan": {"start_um": 0, "step_um": 10, "slices": 11},
  "camera": {"pixel_format": "Mono8", "exposure_us": 5000},
  "focus": {"window_px": 7, "distance_px": 1, "peak": "log_parabola", "extra_peaks": ["nearest"],
            "stage_correction": false},
  "lateral": {"pixel_pitch_x_um": 2.0, "pixel_pitch_y_um": 4.0},
  "result": {"min_valid_fraction": 0.5}})";

class AProcessWithARecipe : public testing::Test {
 protected:
  AProcessWithARecipe() {
    test::write_stack(scratch_ / "in", "s", ".png", 11, 4.0);
    test::write_text(scratch_ / "part.json", kRecipe);
  }
  test::Outcome run(std::vector<std::string> more) {
    std::vector<std::string> arguments{scratch_ / "in", "--recipe", scratch_ / "part.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return process(arguments);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return test::read_text(scratch_ / name); }
  [[nodiscard]] nlohmann::json result(const std::string& out) const {
    return nlohmann::json::parse(file(out + "/result.json"));
  }

  ScratchDir scratch_;
};

TEST_F(AProcessWithARecipe, MeasuresAsTheOptionsThatSayTheSame) {
  ASSERT_EQ(run({"--out", scratch_ / "by_recipe"}).code, kExitOk);
  ASSERT_EQ(process({scratch_ / "in", "--z-step-um", "10", "--window", "7", "--distance", "1", "--peak", "log_parabola",
                     "--extra-peak", "nearest", "--out", scratch_ / "by_options"})
                .code,
            kExitOk);
  for (const char* name : {"height.tiff", "height_nearest.tiff", "sigma.tiff"}) {
    const cv::Mat one = read_float(scratch_ / "by_recipe" / name);
    const cv::Mat other = read_float(scratch_ / "by_options" / name);
    ASSERT_EQ(one.total(), 40U * 30U) << name;
    EXPECT_EQ(std::memcmp(one.data, other.data, one.total() * one.elemSize()), 0) << name;
  }
  EXPECT_EQ(file("by_recipe/mask.png"), file("by_options/mask.png"));
  EXPECT_EQ(file("by_recipe/texture.png"), file("by_options/texture.png"));
}

TEST_F(AProcessWithARecipe, TellsTheRecipeAndJudgesByIt) {
  const test::Outcome outcome = run({"--out", scratch_ / "out"});
  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("verdict   pass"));
  const auto told = result("out");
  EXPECT_EQ(told["recipe"]["id"], "part");
  EXPECT_EQ(told["recipe"]["sha256"].get<std::string>().size(), 64U);
  EXPECT_EQ(told["verdict"], "pass");
  EXPECT_EQ(told["focus"]["pixel_pitch_y_um"], 4.0);
  EXPECT_TRUE(told["warnings"].empty());
}

TEST_F(AProcessWithARecipe, EndsAsFailedWhereTooFewPointsAreValid) {
  const test::Outcome outcome = run({"--min-significance", "1000000", "--out", scratch_ / "out"});
  EXPECT_EQ(outcome.code, kExitVerdictFail) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("verdict   fail\nlimit     valid_fraction is 0, the recipe asks for at least 0.5"));
  EXPECT_EQ(result("out")["verdict"], "fail");
}

TEST_F(AProcessWithARecipe, IsChangedByOptionsAndSaysSo) {
  ASSERT_EQ(run({"--window", "9", "--extra-peak", "parabola", "--out", scratch_ / "out"}).code, kExitOk);
  const auto told = result("out");
  EXPECT_EQ(told["focus"]["window_px"], 9);
  EXPECT_EQ(told["focus"]["distance_px"], 1) << "of the recipe";
  EXPECT_EQ(told["focus"]["extra_peaks"][0]["peak"], "parabola");
  EXPECT_TRUE(told["recipe"]["sha256"].is_null()) << "it is not that recipe any more";
  EXPECT_EQ(told["warnings"][0]["code"], "recipe_overridden");
  EXPECT_THAT(told["warnings"][0]["text"].get<std::string>(), HasSubstr("--window, --extra-peak"));
}

TEST_F(AProcessWithARecipe, MakesTheFilesThatOptionsAskForWhateverItsExportLists) {
  test::write_text(scratch_ / "part.json", R"({"format": 2, "acquire": {"scan": {"start_um": 0, "step_um": 10,
    "slices": 11}}, "export": ["height.tiff"]})");
  ASSERT_EQ(run({"--smooth", "3", "--extra-peak", "nearest", "--out", scratch_ / "out"}).code, kExitOk);
  for (const char* file : {"height.tiff", "height_smooth.tiff", "sigma_smooth.tiff", "height_nearest.tiff"}) {
    EXPECT_TRUE(fs::exists(scratch_ / "out" / file)) << file;
  }
  EXPECT_FALSE(fs::exists(scratch_ / "out/mask.png"));
}

TEST_F(AProcessWithARecipe, TakesHeightsFromTheSlicesOwnFileBeforeTheRecipes) {
  ASSERT_EQ(run({"--out", scratch_ / "planned"}).code, kExitOk);
  EXPECT_EQ(result("planned")["slices"]["last_um"], 100.0);
  std::string heights;
  for (int i = 0; i < 11; ++i) heights += std::to_string(5 * i) + "\n";
  test::write_text(scratch_ / "in/z.txt", heights);
  ASSERT_EQ(run({"--out", scratch_ / "recorded"}).code, kExitOk);
  EXPECT_EQ(result("recorded")["slices"]["last_um"], 50.0);
  ASSERT_EQ(run({"--z-step-um", "3", "--out", scratch_ / "typed"}).code, kExitOk);
  EXPECT_EQ(result("typed")["slices"]["last_um"], 30.0);
}

TEST_F(AProcessWithARecipe, RefusesHeightsThatSeemToBeInAnotherUnit) {
  std::string heights;
  for (int i = 0; i < 11; ++i) heights += std::to_string(0.01 * i) + "\n";
  test::write_text(scratch_ / "in/z.txt", heights);
  const test::Outcome refused = run({"--out", scratch_ / "out"});
  EXPECT_EQ(refused.code, kExitBadData);
  EXPECT_THAT(refused.err, HasSubstr("z.txt: the step is 0.01 um, the recipe's is 10 um"));
  EXPECT_THAT(refused.err, HasSubstr("--z-unit mm or m"));
  EXPECT_FALSE(fs::exists(scratch_ / "out"));
  ASSERT_EQ(run({"--z-file", scratch_ / "in/z.txt", "--z-unit", "mm", "--out", scratch_ / "mm"}).code, kExitOk);
  EXPECT_EQ(result("mm")["slices"]["last_um"], 100.0);
  EXPECT_TRUE(result("mm")["warnings"].empty());
  ASSERT_EQ(run({"--z-file", scratch_ / "in/z.txt", "--z-unit", "um", "--out", scratch_ / "um"}).code, kExitOk)
      << "the unit was said";
  EXPECT_EQ(result("um")["warnings"][0]["code"], "step_differs");
}

TEST(Process, WarnsOfAUnitThatNobodySaidWithOddSteps) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 4, 2.0);
  test::write_text(scratch / "z.txt", "0\n0.01\n0.02\n0.03\n");
  const test::Outcome outcome = process({scratch / "in", "--z-file", scratch / "z.txt", "--out", scratch / "out"});
  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("z.txt: the step is 0.01 um: if its numbers are not in um"));
}

TEST_F(AProcessWithARecipe, WarnsOfOtherSlicesThanTheRecipePlans) {
  std::string recipe = kRecipe;
  recipe.replace(recipe.find("11"), 2, "12");
  test::write_text(scratch_ / "part.json", recipe);
  ASSERT_EQ(run({"--z-step-um", "9", "--out", scratch_ / "out"}).code, kExitOk);
  const auto warnings = result("out")["warnings"];
  ASSERT_EQ(warnings.size(), 2U) << warnings;
  EXPECT_EQ(warnings[0]["code"], "slices_differ");
  EXPECT_EQ(warnings[0]["text"], "there are 11 slices, the recipe has 12");
  EXPECT_EQ(warnings[1]["code"], "step_differs");
  EXPECT_EQ(warnings[1]["text"], "the step is 9 um, the recipe's is 10 um");
}

TEST_F(AProcessWithARecipe, TakesBinsFromTheSlicesOwnStep) {
  test::write_stack(scratch_ / "in", "s", ".png", 31, 14.0);
  std::string recipe = kRecipe;
  recipe.replace(recipe.find("\"step_um\": 10, \"slices\": 11"), 27, "\"step_um\": 2, \"slices\": 101");
  recipe.replace(recipe.find("\"window_px\""), 0, "\"curve_width_um\": 30, ");
  test::write_text(scratch_ / "part.json", recipe);
  const auto bins = [&](const std::string& out, std::vector<std::string> options) {
    options.insert(options.end(), {"--out", scratch_ / out});
    EXPECT_EQ(run(options).code, kExitOk);
    return result(out)["focus"]["bin_slices"].get<int>();
  };
  EXPECT_EQ(bins("planned", {"--z-step-um", "2.01"}), 3) << "as the recipe says, within the error of a stage";
  EXPECT_EQ(bins("own", {"--z-step-um", "10"}), 1);
  EXPECT_EQ(bins("told", {"--z-step-um", "10", "--bin", "1"}), 1);
  const cv::Mat one = read_float(scratch_ / "own/height.tiff");
  const cv::Mat other = read_float(scratch_ / "told/height.tiff");
  EXPECT_EQ(std::memcmp(one.data, other.data, one.total() * one.elemSize()), 0);
}

TEST_F(AProcessWithARecipe, WarnsWhereTheSlicesSpanLessThanTheFocusCurve) {
  std::string recipe = kRecipe;
  recipe.replace(recipe.find("\"window_px\""), 0, "\"curve_width_um\": 200, \"bin_slices\": 1, ");
  test::write_text(scratch_ / "part.json", recipe);
  ASSERT_EQ(run({"--out", scratch_ / "out"}).code, kExitOk);
  EXPECT_EQ(result("out")["warnings"][0]["code"], "range_short");
}

TEST_F(AProcessWithARecipe, RefusesABadRecipeAndLeavesNothing) {
  test::write_text(scratch_ / "part.json", R"({"scan": {"start_um": 0, "step_um": -1, "slices": 11}})");
  const test::Outcome outcome = run({"--out", scratch_ / "out"});
  EXPECT_EQ(outcome.code, kExitBadData);
  EXPECT_THAT(outcome.err, HasSubstr("/scan/step_um"));
  EXPECT_FALSE(fs::exists(scratch_ / "out"));
  EXPECT_EQ(process({scratch_ / "in", "--recipe", scratch_ / "none.json", "--out", scratch_ / "out"}).code, kExitUsage);
}

}  // namespace
}  // namespace fvd::ctl
