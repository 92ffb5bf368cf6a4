/// fvdctl suggest.

#include <filesystem>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "tests/daemon/ctl/run_command.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"

namespace fvd::ctl {
namespace {

using test::Outcome;
using test::ScratchDir;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST(Suggest, PrintsSettingsForARecipeAndRefusesWhatItCannotRead) {
  const ScratchDir scratch;
  fs::create_directories(scratch / "in");
  cv::Mat image(200, 400, CV_8UC1, cv::Scalar(100));  // bare on the left, three columns a period on the right
  for (int x = 150; x < image.cols; x += 3) image.col(x).setTo(160);
  cv::imwrite((scratch / "in/s2.png").string(), image);
  const auto suggest = [](const std::string& file) { return test::run_command({"suggest", file}); };
  const Outcome good = suggest((scratch / "in/s2.png").string());
  EXPECT_EQ(good.code, kExitOk) << good.err;
  EXPECT_THAT(good.out, HasSubstr("\"distance_px\": 2, \"window_px\": 9 }  (the defaults)"));
  const Outcome bad = suggest((scratch / "in/s9.png").string());
  EXPECT_NE(bad.code, kExitOk);
  EXPECT_THAT(bad.err, HasSubstr("there is no file or folder " + (scratch / "in/s9.png").string()));
  const Outcome chosen = test::run_command({"suggest", scratch / "in/s2.png", "--channel", "2"});
  EXPECT_EQ(chosen.code, kExitBadData);
  EXPECT_THAT(chosen.err, HasSubstr("s2.png is one image"));
}

TEST(Suggest, LooksAtAWholeStack) {
  const ScratchDir scratch;
  fs::create_directories(scratch / "in");
  for (int i = 10; i < 41; ++i) {
    cv::Mat slice;
    cv::repeat(test::pattern_slice(i, 24.0, CV_8UC1), 2, 2, slice);
    cv::imwrite((scratch / "in" / ("s" + std::to_string(i) + ".png")).string(), slice);
  }
  std::ostringstream out;
  std::ostringstream err;
  ASSERT_EQ(run_fvdctl({"suggest", scratch / "in"}, {out, err, false, false}), kExitOk) << err.str();
  EXPECT_THAT(out.str(), HasSubstr("\"window_px\": 9"));
  EXPECT_THAT(out.str(), HasSubstr("slices wide at half its height"));
}

TEST(Suggest, TellsTheKeysOfAConfocalMicroscopeByItsOptics) {
  const Outcome good = test::run_command({"suggest", "--na", "0.95", "--wavelength-nm", "405"});
  EXPECT_EQ(good.code, kExitOk) << good.err;
  EXPECT_THAT(good.out, HasSubstr("\"step_um\": 0.086"));
  EXPECT_THAT(good.out, HasSubstr("\"operator\": \"intensity\", \"window_px\": 1, \"curve_width_um\": 0.261"));
  const Outcome none = test::run_command({"suggest", "--na", "1.2", "--wavelength-nm", "405"});
  EXPECT_EQ(none.code, kExitBadData);
  EXPECT_THAT(none.err, HasSubstr("below the refractive index"));
  EXPECT_NE(test::run_command({"suggest", "--na", "0.8"}).code, kExitOk) << "of which light?";
  EXPECT_NE(test::run_command({"suggest"}).code, kExitOk);
}

TEST(Suggest, ChoosesTheSlicesAsProcessDoes) {
  const ScratchDir scratch;
  fs::create_directories(scratch / "in");
  for (int i = 0; i < 9; ++i) {
    for (const char* const name : {"left", "right"}) {
      cv::imwrite((scratch / "in" / (name + std::to_string(i) + ".png")).string(),
                  test::pattern_slice(i, 4.0, CV_8UC1, 80, 60));
    }
  }
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(run_fvdctl({"suggest", scratch / "in"}, {out, err, false, false}), kExitBadData);
  EXPECT_THAT(err.str(), HasSubstr("--pattern"));
  EXPECT_EQ(run_fvdctl({"suggest", scratch / "in", "--pattern", "left{n}.png"}, {out, err, false, false}), kExitOk)
      << err.str();
  EXPECT_THAT(out.str(), HasSubstr("slices wide at half its height"));
}

}  // namespace
}  // namespace fvd::ctl
