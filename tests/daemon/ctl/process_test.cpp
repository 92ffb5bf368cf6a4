#include <cmath>
#include <cstring>
#include <optional>
#include <ostream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"

namespace fvd::ctl {
namespace {

using test::ScratchDir;
using testing::HasSubstr;
namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

Outcome process(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "process");
  std::ostringstream out;
  std::ostringstream err;
  const int code = run_fvdctl(arguments, {out, err, false, false});
  return {code, out.str(), err.str()};
}

cv::Mat read_float(const fs::path& path) { return cv::imread(path.string(), cv::IMREAD_UNCHANGED); }

TEST(Process, MakesTheAllInFocusImageInTheColoursOfTheSlices) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 11, 4.0, CV_16UC3);
  ASSERT_EQ(process({scratch / "in", "--z-step-um", "10", "--out", scratch / "out"}).code, kExitOk);
  const cv::Mat texture = cv::imread((scratch / "out/texture.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(texture.type(), CV_8UC3);
  const cv::Mat sharpest = test::pattern_slice(4, 4.0, CV_16UC3);
  for (const auto& [x, y] : {std::pair{7, 7}, {20, 15}, {33, 22}}) {
    EXPECT_NEAR(texture.at<cv::Vec3b>(y, x)[1], sharpest.at<cv::Vec3w>(y, x)[1] / 257.0, 1.0);
  }
}

TEST(Process, MakesAHeightMapOfRecordedSlices) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 11, 4.0);
  const Outcome outcome = process({scratch / "in", "--z-step-um", "10", "--z-start-um", "-7", "--extra-peak", "nearest",
                                   "--bin", "1", "--pixel-pitch-um", "2", "--out", scratch / "out"});
  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("s*.png (11 files), 40 x 30 pixels"));
  EXPECT_THAT(outcome.err, HasSubstr("slice 11/11"));
  const cv::Mat height = read_float(scratch / "out/height.tiff");
  ASSERT_EQ(height.type(), CV_32FC1);
  for (int y = 0; y < height.rows; ++y) {
    for (int x = 0; x < height.cols; ++x) ASSERT_NEAR(static_cast<double>(height.at<float>(y, x)), 33e-6, 0.5e-6);
  }
  EXPECT_EQ(read_float(scratch / "out/height_nearest.tiff").at<float>(7, 7), 33e-6F);
  const auto result = nlohmann::json::parse(test::read_text(scratch / "out/result.json"));
  EXPECT_EQ(result["frames"]["ok"], 11);
  EXPECT_EQ(result["slices"]["measured"], 11);
  EXPECT_EQ(result["focus"]["pixel_pitch_x_um"], 2.0);
  EXPECT_EQ(result["job"]["part_id"], "in");
  EXPECT_THAT(result["provenance"]["source"].get<std::string>(), HasSubstr("s*.png"));
}

TEST(Process, NamesTheFileOfALeftOutSlice) {
  const ScratchDir scratch;
  fs::create_directory(scratch / "in");
  for (int i = 0; i < 11; ++i) {
    cv::Mat image = test::pattern_slice(i, 5.0, CV_8UC1, 160, 120);
    if (i == 7) image.setTo(51);
    cv::imwrite((scratch / "in" / ("s" + std::to_string(i) + ".png")).string(), image);
  }
  const Outcome outcome = process({scratch / "in", "--z-step-um", "10", "--bin", "1", "--out", scratch / "out"});
  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(": s7.png at 70 um has the same grey level everywhere (the level is 20 % of "
                                     "full scale)"));
  const auto result = nlohmann::json::parse(test::read_text(scratch / "out/result.json"));
  ASSERT_EQ(result["slices"]["suspect"].size(), 1U);
  EXPECT_EQ(result["slices"]["suspect"][0]["file"], "s7.png");
  EXPECT_THAT(test::read_text(scratch / "out/step_log.csv"), HasSubstr(",constant\n"));
  const Outcome none =
      process({scratch / "in", "--z-step-um", "10", "--allowed-lost-slices", "0", "--out", scratch / "none"});
  EXPECT_EQ(none.code, kExitBadData);
  EXPECT_THAT(none.err, HasSubstr("s7.png at 70 um"));
  EXPECT_THAT(none.err, HasSubstr("--allowed-lost-slices of fvdctl process"));
}

TEST(Process, NamesTheLimitThatMakesNearlyAllHoles) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 11, 5.0);
  const Outcome outcome =
      process({scratch / "in", "--z-step-um", "10", "--bin", "1", "--max-sigma", "1e-6", "--out", scratch / "out"});
  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("not one point is valid; "));
  EXPECT_THAT(outcome.out, HasSubstr("larger standard error than allowed (max_sigma_um)"));
}

TEST(Process, ChoosesItsBinsByTheWidthThatAFirstPassTells) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 31, 14.0);
  const auto focus_of = [&](const std::string& out, std::vector<std::string> options) {
    options.insert(options.begin(), {scratch / "in", "--z-step-um", "10", "--out", scratch / out});
    const Outcome outcome = process(options);
    EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
    const auto result = nlohmann::json::parse(test::read_text(scratch / out / "result.json"));
    EXPECT_EQ(result["frames"]["ok"], 31);
    EXPECT_EQ(result["slices"]["measured"], 31);
    EXPECT_THAT(result["warnings"], ::testing::IsEmpty());
    return result["focus"];
  };
  const auto without = focus_of("without", {"--bin", "1"});
  EXPECT_EQ(without["bins_by"], "recipe");
  const auto itself = focus_of("itself", {});
  EXPECT_EQ(itself["bins_by"], "slices");
  EXPECT_EQ(itself["bin_slices"], choose_bin_slices(10.0, without["curve_width_um"].get<double>(), 31));
  ASSERT_GT(itself["bin_slices"], 1);
  EXPECT_EQ(read_float(scratch / "itself/height.tiff").rows, 30);
}

TEST(Process, BinsNoStackThatIsTooShort) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 14, 7.0);
  ASSERT_EQ(process({scratch / "in", "--z-step-um", "10", "--out", scratch / "out"}).code, kExitOk);
  const auto focus = nlohmann::json::parse(test::read_text(scratch / "out/result.json"))["focus"];
  EXPECT_GT(choose_bin_slices(10.0, focus["curve_width_um"].get<double>()), 1);
  EXPECT_EQ(focus["bin_slices"], 1);
  EXPECT_EQ(focus["bins_by"], "slices") << "which told the width";
}

TEST(Process, BinsNoStackWhoseHeightsThatWouldCost) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 31, 1.2);
  ASSERT_EQ(process({scratch / "in", "--z-step-um", "10", "--out", scratch / "out"}).code, kExitOk);
  const auto result = nlohmann::json::parse(test::read_text(scratch / "out/result.json"));
  EXPECT_GT(choose_bin_slices(10.0, result["focus"]["curve_width_um"].get<double>(), 31), 1);
  EXPECT_EQ(result["focus"]["bin_slices"], 1);
  EXPECT_EQ(result["focus"]["bins_by"], "slices");
  EXPECT_THAT(result["warnings"], ::testing::IsEmpty());
  const cv::Mat height = read_float(scratch / "out/height.tiff");
  EXPECT_NEAR(static_cast<double>(height.at<float>(15, 20)), 12e-6, 1e-6);
}

TEST(Process, GivesTheSameHeightsBitForBitAsTheScanThatRecordedTheSlices) {
  const ScratchDir scratch;
  WorkerPool pool(2);
  StreamingFocusStack live(40, 30, PixelFormat::kMono12, {}, pool);
  {
    AtomicDirectory directory(scratch / "job");
    SliceRecorder recorder(directory);
    for (int i = 0; i < 9; ++i) {
      const cv::Mat image = test::pattern_slice(i, 3.7, CV_16UC1) / 16;
      const PlaneView<const std::uint16_t> pixels{image.ptr<std::uint16_t>(), 40, 30, 40};
      const double z_um = 10.0 * i + std::sin(i) / 7.0;  // no number that a short decimal could hold
      live.push(image_view(pixels, PixelFormat::kMono12), z_um);
      recorder.add(image_view(pixels, PixelFormat::kMono12), z_um);
    }
    recorder.finish("job 7", true);
    directory.commit();
  }
  const HeightMap expected = live.finish(PeakMethod::kLogParabola);

  const Outcome outcome = process({scratch / "job/slices", "--z-file", scratch / "job/slices/z.txt", "--peak",
                                   "log_parabola", "--bin", "1", "--out", scratch / "out"});

  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_NE(test::read_text(scratch / "out/result.json").find("\"simulated\": true"), std::string::npos)
      << "the slices' z.txt says so";
  const cv::Mat height = read_float(scratch / "out/height.tiff");
  int valid = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const float z = expected.height_m.at(x, y);
      if (std::isnan(z)) {
        ASSERT_TRUE(std::isnan(height.at<float>(y, x)));
      } else {
        ASSERT_EQ(height.at<float>(y, x), z);
        ++valid;
      }
    }
  }
  EXPECT_GT(valid, 1000);
}

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
  Outcome run(std::vector<std::string> more) {
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
  const Outcome outcome = run({"--out", scratch_ / "out"});
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
  const Outcome outcome = run({"--min-significance", "1000000", "--out", scratch_ / "out"});
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
  const Outcome refused = run({"--out", scratch_ / "out"});
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
  const Outcome outcome = process({scratch / "in", "--z-file", scratch / "z.txt", "--out", scratch / "out"});
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

TEST(Process, RefusesFewerSlicesThanAPeakNeeds) {
  const ScratchDir scratch;
  test::write_stack(scratch / "two", "s", ".png", 2, 1.0);
  const Outcome two = process({scratch / "two", "--z-step-um", "10", "--out", scratch / "out"});
  EXPECT_EQ(two.code, kExitBadData);
  EXPECT_THAT(two.err, HasSubstr("two has 2 slices; a peak needs at least 3"));
  test::write_stack(scratch / "four", "s", ".png", 4, 1.0);
  const Outcome four = process({scratch / "four", "--z-step-um", "10", "--bin", "2", "--out", scratch / "out"});
  EXPECT_EQ(four.code, kExitBadData);
  EXPECT_THAT(four.err, HasSubstr("four has 4 slices; a peak needs at least 5"));
  EXPECT_THAT(four.err, HasSubstr("in bins of 2 slices"));
  EXPECT_FALSE(fs::exists(scratch / "out"));
}

TEST_F(AProcessWithARecipe, RefusesABadRecipeAndLeavesNothing) {
  test::write_text(scratch_ / "part.json", R"({"scan": {"start_um": 0, "step_um": -1, "slices": 11}})");
  const Outcome outcome = run({"--out", scratch_ / "out"});
  EXPECT_EQ(outcome.code, kExitBadData);
  EXPECT_THAT(outcome.err, HasSubstr("/scan/step_um"));
  EXPECT_FALSE(fs::exists(scratch_ / "out"));
  EXPECT_EQ(process({scratch_ / "in", "--recipe", scratch_ / "none.json", "--out", scratch_ / "out"}).code, kExitUsage);
}

/// What goes wrong, which file the message must name, and the exit code.
struct BadStack {
  const char* what;
  void (*spoil)(const fs::path& folder);
  const char* named;
};

/// For the names of the tests.
inline void PrintTo(const BadStack& of, std::ostream* out) { *out << of.what; }

class ABadStack : public testing::TestWithParam<BadStack> {};

TEST_P(ABadStack, IsRefusedByNameAndLeavesNothing) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 6, 3.0);
  GetParam().spoil(scratch / "in");
  const Outcome outcome = process({scratch / "in", "--z-step-um", "10", "--out", scratch / "out"});
  EXPECT_EQ(outcome.code, kExitBadData);
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().named));
  EXPECT_THAT(scratch.entries(), testing::ElementsAre("in"));
}

INSTANTIATE_TEST_SUITE_P(
    Folder, ABadStack,
    testing::Values(BadStack{"LastSliceOfAnotherSize",
                             [](const fs::path& folder) {
                               cv::imwrite((folder / "s5.png").string(), test::pattern_slice(5, 3, CV_8UC1, 39, 30));
                             },
                             "s5.png"},
                    BadStack{"LastSliceOfAnotherDepth",
                             [](const fs::path& folder) {
                               cv::imwrite((folder / "s5.png").string(), test::pattern_slice(5, 3, CV_16UC1));
                             },
                             "s5.png"},
                    BadStack{"TruncatedSlice",
                             [](const fs::path& folder) {
                               test::write_text(folder / "s4.png", test::read_text(folder / "s4.png").substr(0, 300));
                             },
                             "s4.png"},
                    BadStack{"NoImage", [](const fs::path& folder) { test::write_text(folder / "s2.png", "text"); },
                             "s2.png"},
                    BadStack{"MissingSlice", [](const fs::path& folder) { fs::remove(folder / "s2.png"); },
                             "s1.png is followed by s3.png"},
                    BadStack{"OneSlice",
                             [](const fs::path& folder) {
                               for (int i = 1; i < 6; ++i) fs::remove(folder / ("s" + std::to_string(i) + ".png"));
                             },
                             "only one slice"},
                    BadStack{"EmptyFolder",
                             [](const fs::path& folder) {
                               fs::remove_all(folder);
                               fs::create_directory(folder);
                             },
                             "no slices in"}),
    [](const auto& stack) { return stack.param.what; });

TEST(Process, RefusesWhatItWouldOnlyFindOutLater) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 3, 1.0);
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{scratch / "in", "--z-step-um", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return process(arguments);
  };
  EXPECT_EQ(with({"--out", scratch / "in"}).code, kExitIo) << "exists";
  const Outcome nowhere = with({"--out", scratch / "nowhere/out"});
  EXPECT_EQ(nowhere.code, kExitIo);
  EXPECT_THAT(nowhere.err, HasSubstr("there is no folder " + (scratch / "nowhere").string()));
  EXPECT_THAT(nowhere.err, ::testing::Not(HasSubstr("slice"))) << "before the first one is read";
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--window", "8"},
                                                                                      {"--window", "65"},
                                                                                      {"--distance", "8"},
                                                                                      {"--bin", "0"},
                                                                                      {"--min-prominence", "1.5"},
                                                                                      {"--min-significance", "-1"},
                                                                                      {"--broad-curve", "2"},
                                                                                      {"--narrow-curve", "2"},
                                                                                      {"--second-peak", "8"},
                                                                                      {"--clipped-share", "2"},
                                                                                      {"--edge-band", "-1"},
                                                                                      {"--max-sigma", "-1"},
                                                                                      {"--pixel-pitch-um", "-1"}}) {
    const Outcome outcome = with({"--out", scratch / "out", option, value});
    EXPECT_EQ(outcome.code, kExitUsage) << option;
    EXPECT_THAT(outcome.err, HasSubstr(option)) << "names it";
  }
  const Outcome twice = with({"--out", scratch / "out", "--peak", "parabola", "--extra-peak", "parabola"});
  EXPECT_EQ(twice.code, kExitUsage);
  EXPECT_THAT(twice.err, HasSubstr("--extra-peak parabola is the peak of height.tiff already"));
  EXPECT_EQ(process({scratch / "in", "--z-step-um", "1e-9", "--out", scratch / "out"}).code, kExitBadData);
  EXPECT_THAT(scratch.entries(), testing::ElementsAre("in"));
}

}  // namespace
}  // namespace fvd::ctl
