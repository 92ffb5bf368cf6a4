#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"

namespace fvd::ctl {
namespace {

using testing::HasSubstr;
using Names = std::vector<std::string>;

/// Eleven slices 10 um apart of a plane in focus at the fifth, under any names.
class SlicesOfAPlane : public testing::Test {
 protected:
  static constexpr int kSlices = 11;

  void write(const Names& names, double focus = 4.0) {
    std::filesystem::create_directories(scratch_ / "in");
    for (std::size_t i = 0; i < names.size(); ++i) {
      cv::imwrite((scratch_ / "in" / names[i]).string(), test::pattern_slice(static_cast<double>(i), focus));
    }
  }

  /// Names with first, first + step ... in the place of '#'.
  static Names names(const std::string& text, int first, int step) {
    Names result;
    for (int i = 0; i < kSlices; ++i) {
      result.push_back(std::string(text).replace(text.find('#'), 1, std::to_string(first + i * step)));
    }
    return result;
  }

  int run(const Names& options) {
    Names arguments{"process", scratch_ / "in", "--bin", "1", "--out", scratch_ / "out"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    std::ostringstream out;
    std::ostringstream err;
    const int code = run_fvdctl(arguments, {out, err, false, false});
    out_ = out.str();
    err_ = err.str();
    return code;
  }

  /// The plane's height, and that every point has it.
  void expect_height_um(double expected_um) {
    const cv::Mat height = cv::imread((scratch_ / "out/height.tiff").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(height.total(), 40U * 30U);
    for (int y = 0; y < height.rows; ++y) {
      for (int x = 0; x < height.cols; ++x) {
        ASSERT_NEAR(static_cast<double>(height.at<float>(y, x)), expected_um * 1e-6, 0.5e-6) << x << ", " << y;
      }
    }
  }

  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(test::read_text(scratch_ / "out/result.json"));
  }

  test::ScratchDir scratch_;
  std::string out_;
  std::string err_;
};

TEST_F(SlicesOfAPlane, WithNegativeZInTheirNamesAreAllUsed) {
  write(names("z#.png", -20, 10));
  ASSERT_EQ(run({"--z-step-um", "10", "--z-start-um", "-20"}), kExitOk) << err_;
  EXPECT_THAT(out_, HasSubstr("z*.png (11 files), 40 x 30 pixels\nfiles     11 used + 0 ignored = 11\n"));
  expect_height_um(20);
}

TEST_F(SlicesOfAPlane, HaveTheZInTheirNamesWhereTheUnitIsThere) {
  write(names("stack_z#um.png", -50, 10));
  ASSERT_EQ(run({}), kExitOk) << err_;
  EXPECT_TRUE(result()["warnings"].empty());
  expect_height_um(-10);
}

TEST_F(SlicesOfAPlane, GoDownwardsWithTheirNames) {
  Names down;
  for (int i = 0; i < kSlices; ++i)
    down.push_back(std::to_string(100 + i) + "_z" + std::to_string(50 - 10 * i) + "um.png");
  write(down);
  ASSERT_EQ(run({}), kExitOk) << err_;
  EXPECT_EQ(result()["slices"]["first_um"], 50.0);
  expect_height_um(10);
}

TEST_F(SlicesOfAPlane, NeedTheUnitOfZInNamesOrPattern) {
  write(names("z#.png", -20, 10));
  EXPECT_EQ(run({}), kExitUsage);
  EXPECT_THAT(err_, HasSubstr("z-20.png do not say it with a unit"));
  EXPECT_THAT(err_, HasSubstr("--pattern with {z_um} or {z_mm}"));
  ASSERT_EQ(run({"--pattern", "z{z_um}.png"}), kExitOk) << err_;
  expect_height_um(20);
}

TEST_F(SlicesOfAPlane, AreNotMovedByAStartAlone) {
  write(names("z#um.png", -20, 10));
  EXPECT_EQ(run({"--z-start-um", "5"}), kExitUsage);
  EXPECT_THAT(err_, HasSubstr("--z-start-um says nothing without --z-step-um or --recipe"));
}

TEST_F(SlicesOfAPlane, MayBeCountedOverTheEndOfTheCounter) {
  Names rolling = names("DSC_#.png", 9995, 1);
  for (int i = 5; i < kSlices; ++i) rolling[static_cast<std::size_t>(i)] = "DSC_000" + std::to_string(i - 4) + ".png";
  write(rolling);
  ASSERT_EQ(run({"--z-step-um", "10"}), kExitOk) << err_;
  EXPECT_THAT(out_, HasSubstr("DSC_*.png (11 files, the counter rolls over)"));
  expect_height_um(40);
  std::filesystem::remove_all(scratch_ / "out");
  std::string heights;
  for (int i = 0; i < kSlices; ++i) heights += std::to_string(10 * i) + "\n";
  test::write_text(scratch_ / "z.txt", heights);
  ASSERT_EQ(run({"--z-file", scratch_ / "z.txt"}), kExitOk) << err_;
  expect_height_um(40);
}

TEST_F(SlicesOfAPlane, MayHaveAListInUtf16AndWithPlusSigns) {
  write(names("s#.png", 0, 1));
  std::string wide = "\xFF\xFE";
  std::string plus;
  for (int i = 0; i < kSlices; ++i) {
    for (const char c : std::to_string(10 * i) + "\r\n") wide += {c, '\0'};
    plus += "+" + std::to_string(10 * i) + ".0\n";
  }
  for (const std::string& text : {wide, plus}) {
    test::write_text(scratch_ / "z.txt", text);
    ASSERT_EQ(run({"--z-file", scratch_ / "z.txt"}), kExitOk) << err_;
    expect_height_um(40);
    std::filesystem::remove_all(scratch_ / "out");
  }
}

TEST_F(SlicesOfAPlane, MayHaveTheirChannelOrObjectiveAfterZ) {
  for (const char* text : {"Series001_z#_ch00.png", "S#_20x.png"}) {
    write(names(text, 0, 1));
    ASSERT_EQ(run({"--z-step-um", "10"}), kExitOk) << err_;
    expect_height_um(40);
    std::filesystem::remove_all(scratch_ / "out");
    std::filesystem::remove_all(scratch_ / "in");
  }
}

TEST_F(SlicesOfAPlane, InSeveralChannelsNeedAPatternAndTheOthersAreNamed) {
  write(names("Series001_z#_ch00.png", 0, 1));
  write(names("Series001_z#_ch01.png", 0, 1), 8.0);
  write(names("Series001_z#_ch02.png", 0, 1), 2.0);
  EXPECT_EQ(run({"--z-step-um", "10"}), kExitBadData);
  EXPECT_THAT(err_, HasSubstr("Series001_z{n}_ch00.png"));
  ASSERT_EQ(run({"--z-step-um", "10", "--pattern", "Series001_z{n}_ch01.png"}), kExitOk) << err_;
  EXPECT_THAT(out_, HasSubstr("files     11 used + 22 ignored = 33\n"));
  EXPECT_THAT(out_, HasSubstr("warning   22 image files are not taken for slices: Series001_z0_ch00.png, "));
  EXPECT_EQ(result()["warnings"][0]["code"], "files_ignored");
  EXPECT_THAT(result()["provenance"]["source"].get<std::string>(), HasSubstr("11 used + 22 ignored = 33"));
  expect_height_um(80);
}

TEST_F(SlicesOfAPlane, WarnOfAStepThatIsNotTheirNames) {
  write(names("z#um.png", 0, 5));
  ASSERT_EQ(run({"--z-step-um", "10"}), kExitOk) << err_;
  EXPECT_THAT(out_, HasSubstr("the step is 10 um, the z in the names are 5 um apart"));
  expect_height_um(40);
}

}  // namespace
}  // namespace fvd::ctl
