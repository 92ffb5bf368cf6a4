/// Pages and bits of recorded stacks as programs write them: each gives the height that is in it, or a question.

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"
#include "tests/support/tiff_writer.hpp"

namespace fvd::ctl {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr int kPages = 11;
constexpr double kStep_um = 10.0;
/// In focus at slice 4.
constexpr double kFocus = 4.0;

cv::Mat slice(int index, int type = CV_16UC1) { return test::pattern_slice(index, kFocus, type); }

class ARecordedStack : public testing::Test {
 protected:
  int process(std::vector<std::string> options, const std::string& source = "in") {
    fs::remove_all(scratch_ / "out");
    options.insert(options.begin(), {"process", (scratch_ / source).string(), "--out", (scratch_ / "out").string()});
    std::ostringstream out;
    std::ostringstream err;
    const int code = run_fvdctl(options, {out, err, false, false});
    out_ = out.str();
    err_ = err.str();
    return code;
  }

  /// Of the flat surface, from all of its points.
  [[nodiscard]] double height_um() const {
    const cv::Mat height = cv::imread((scratch_ / "out/height.tiff").string(), cv::IMREAD_UNCHANGED);
    EXPECT_TRUE(cv::checkRange(height)) << "has holes";
    return cv::mean(height)[0] * 1e6;
  }

  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(test::read_text(scratch_ / "out/result.json"));
  }

  const test::ScratchDir scratch_;
  std::string out_;
  std::string err_;
};

constexpr double kTolerance_um = 0.5;

TEST_F(ARecordedStack, OfTwoChannelsAsksWhichOne) {
  std::vector<test::TiffPageSpec> pages;
  for (int i = 0; i < kPages; ++i) {
    pages.push_back(
        {slice(i), i == 0 ? "ImageJ=1.53t\nimages=22\nchannels=2\nslices=11\nspacing=10.0\nunit=um\n" : "", 0, 0});
    pages.push_back({cv::Mat(slice(i) / 3), "", 0, 0});
  }
  test::write_tiff(scratch_ / "zc.tif", pages);
  EXPECT_EQ(process({"--z-step-um", "10"}, "zc.tif"), kExitBadData);
  EXPECT_THAT(err_, testing::AllOf(HasSubstr("2 channels"), HasSubstr("--channel")));
  for (const char* channel : {"1", "2"}) {
    ASSERT_EQ(process({"--channel", channel}, "zc.tif"), kExitOk) << err_;
    EXPECT_NEAR(height_um(), kFocus * kStep_um, kTolerance_um);
    EXPECT_THAT(out_, HasSubstr("pages: 11 used + 11 ignored = 22"));
  }
}

TEST_F(ARecordedStack, Of12BitsIn16SaturatesAt4095) {
  fs::create_directories(scratch_ / "in");
  for (int i = 0; i < kPages; ++i) {
    cv::Mat image = slice(i) / 16;
    image(cv::Rect(10, 10, 12, 12)).setTo(4095);
    cv::imwrite((scratch_ / "in" / ("s" + std::to_string(i) + ".png")).string(), image);
  }
  ASSERT_EQ(process({"--z-step-um", "10"}), kExitOk) << err_;
  EXPECT_THAT(out_, HasSubstr("12 significant bits"));
  EXPECT_GT(result()["values"]["hole_points"]["saturated"], 0);
  ASSERT_EQ(process({"--z-step-um", "10", "--significant-bits", "16"}), kExitOk) << err_;
  EXPECT_EQ(result()["values"]["hole_points"]["saturated"], 0);
}

TEST_F(ARecordedStack, Of8BitsHasNoMoreWhateverTheOptionSays) {
  test::write_stack(scratch_ / "in", "s", ".png", kPages, kFocus);
  EXPECT_EQ(process({"--z-step-um", "10", "--significant-bits", "12"}), kExitBadData);
  EXPECT_THAT(err_, HasSubstr("s0.png in " + (scratch_ / "in").string() + " does not fit --significant-bits 12"));
  EXPECT_THAT(err_, testing::Not(HasSubstr("damaged")));
}

TEST_F(ARecordedStack, OfOnePageIsRefusedWithoutAPattern) {
  test::write_tiff(scratch_ / "one.tif", {{slice(0), "", 0, 0}});
  EXPECT_EQ(process({"--z-step-um", "10"}, "one.tif"), kExitBadData);
  EXPECT_THAT(err_, HasSubstr("not a TIFF with several pages; expected one, or a folder of slices"));
}

TEST_F(ARecordedStack, OfOmeHasItsPixelPitch) {
  const std::string ome =
      "<OME><Image><Pixels DimensionOrder=\"XYZCT\" SizeZ=\"11\" SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"2.5\" "
      "PhysicalSizeY=\"2.5\" PhysicalSizeZ=\"10\"><TiffData/></Pixels></Image></OME>";
  std::vector<test::TiffPageSpec> pages;
  for (int i = 0; i < kPages; ++i) pages.push_back({slice(i), i == 0 ? ome : "", 0, 0});
  test::write_tiff(scratch_ / "ome.tif", pages);
  ASSERT_EQ(process({}, "ome.tif"), kExitOk) << err_;
  EXPECT_EQ(result()["focus"]["pixel_pitch_x_um"], 2.5);
  ASSERT_EQ(process({"--pixel-pitch-um", "3"}, "ome.tif"), kExitOk) << err_;
  EXPECT_EQ(result()["focus"]["pixel_pitch_y_um"], 3.0);
}

TEST_F(ARecordedStack, OfImageJBehindOneDirectoryIsRead) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < kPages; ++i) images.push_back(slice(i));
  test::write_text(
      scratch_ / "big.tif",
      test::imagej_contiguous_tiff(images, "ImageJ=1.53t\nimages=11\nslices=11\nunit=micron\nspacing=10.0\n"));
  ASSERT_EQ(process({}, "big.tif"), kExitOk) << err_;
  EXPECT_NEAR(height_um(), kFocus * kStep_um, kTolerance_um);
}

TEST_F(ARecordedStack, WithReducedPagesUsesTheFullOnes) {
  std::vector<test::TiffPageSpec> pages;
  for (int i = 0; i < kPages; ++i) pages.push_back({slice(i), "", 0, 0});
  const test::TiffPageSpec reduced{cv::Mat(8, 10, CV_16UC1, cv::Scalar(1)), "", FILETYPE_REDUCEDIMAGE, 0};
  fs::create_directories(scratch_ / "each");
  for (int i = 0; i < kPages; ++i) {
    test::write_tiff(scratch_ / "each" / ("k" + std::to_string(i) + ".tif"),
                     {pages[static_cast<std::size_t>(i)], reduced});
  }
  pages.push_back(reduced);
  test::write_tiff(scratch_ / "last.tif", pages);
  ASSERT_EQ(process({"--z-step-um", "10"}, "last.tif"), kExitOk) << err_;
  EXPECT_NEAR(height_um(), kFocus * kStep_um, kTolerance_um);
  EXPECT_THAT(out_, HasSubstr("pages: 11 used + 1 ignored = 12 (ignored: page 12 [reduced image])"));
  ASSERT_EQ(process({"--z-step-um", "10"}, "each"), kExitOk) << err_;
  EXPECT_NEAR(height_um(), kFocus * kStep_um, kTolerance_um);
}

}  // namespace
}  // namespace fvd::ctl
