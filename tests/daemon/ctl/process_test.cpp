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
  const test::Outcome outcome = process({scratch / "in", "--z-step-um", "10", "--z-start-um", "-7", "--extra-peak",
                                         "nearest", "--bin", "1", "--pixel-pitch-um", "2", "--out", scratch / "out"});
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
  const test::Outcome outcome = process({scratch / "in", "--z-step-um", "10", "--bin", "1", "--out", scratch / "out"});
  ASSERT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(": s7.png at 70 um has the same grey level everywhere (the level is 20 % of "
                                     "full scale)"));
  const auto result = nlohmann::json::parse(test::read_text(scratch / "out/result.json"));
  ASSERT_EQ(result["slices"]["suspect"].size(), 1U);
  EXPECT_EQ(result["slices"]["suspect"][0]["file"], "s7.png");
  EXPECT_THAT(test::read_text(scratch / "out/step_log.csv"), HasSubstr(",constant\n"));
  const test::Outcome none =
      process({scratch / "in", "--z-step-um", "10", "--allowed-lost-slices", "0", "--out", scratch / "none"});
  EXPECT_EQ(none.code, kExitBadData);
  EXPECT_THAT(none.err, HasSubstr("s7.png at 70 um"));
  EXPECT_THAT(none.err, HasSubstr("--allowed-lost-slices of fvdctl process"));
}

TEST(Process, NamesTheLimitThatMakesNearlyAllHoles) {
  const ScratchDir scratch;
  test::write_stack(scratch / "in", "s", ".png", 11, 5.0);
  const test::Outcome outcome =
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
    const test::Outcome outcome = process(options);
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

  const test::Outcome outcome = process({scratch / "job/slices", "--z-file", scratch / "job/slices/z.txt", "--peak",
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

TEST(Process, RefusesFewerSlicesThanAPeakNeeds) {
  const ScratchDir scratch;
  test::write_stack(scratch / "two", "s", ".png", 2, 1.0);
  const test::Outcome two = process({scratch / "two", "--z-step-um", "10", "--out", scratch / "out"});
  EXPECT_EQ(two.code, kExitBadData);
  EXPECT_THAT(two.err, HasSubstr("two has 2 slices; a peak needs at least 3"));
  test::write_stack(scratch / "four", "s", ".png", 4, 1.0);
  const test::Outcome four = process({scratch / "four", "--z-step-um", "10", "--bin", "2", "--out", scratch / "out"});
  EXPECT_EQ(four.code, kExitBadData);
  EXPECT_THAT(four.err, HasSubstr("four has 4 slices; a peak needs at least 5"));
  EXPECT_THAT(four.err, HasSubstr("in bins of 2 slices"));
  EXPECT_FALSE(fs::exists(scratch / "out"));
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
  const test::Outcome outcome = process({scratch / "in", "--z-step-um", "10", "--out", scratch / "out"});
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
  const test::Outcome nowhere = with({"--out", scratch / "nowhere/out"});
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
    const test::Outcome outcome = with({"--out", scratch / "out", option, value});
    EXPECT_EQ(outcome.code, kExitUsage) << option;
    EXPECT_THAT(outcome.err, HasSubstr(option)) << "names it";
  }
  const test::Outcome twice = with({"--out", scratch / "out", "--peak", "parabola", "--extra-peak", "parabola"});
  EXPECT_EQ(twice.code, kExitUsage);
  EXPECT_THAT(twice.err, HasSubstr("--extra-peak parabola is the peak of height.tiff already"));
  EXPECT_EQ(process({scratch / "in", "--z-step-um", "1e-9", "--out", scratch / "out"}).code, kExitBadData);
  const test::Outcome unnamed = with({"--out", ""});
  EXPECT_EQ(unnamed.code, kExitUsage);
  EXPECT_THAT(unnamed.err, HasSubstr("--out is empty"));
  EXPECT_THAT(scratch.entries(), testing::ElementsAre("in"));
  const test::Outcome unsmooth = with({"--out", scratch / "out", "--smooth", "nan"});
  EXPECT_EQ(unsmooth.code, kExitUsage);
  EXPECT_THAT(unsmooth.err, ::testing::StartsWith("--smooth: 'nan' is no number")) << "before the first one is read";
  fs::create_symlink("nothing", scratch / "link");
  const test::Outcome link = with({"--out", scratch / "link"});
  EXPECT_EQ(link.code, kExitIo);
  EXPECT_THAT(link.err, ::testing::StartsWith("fvdctl: " + (scratch / "link").string() + " exists already"));
}

}  // namespace
}  // namespace fvd::ctl
