#include "drivers/replay/recorded_stack.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"

namespace fvd {
namespace {

using test::expect_error;
using test::pattern_slice;
using test::ScratchDir;
using test::write_pages;
using test::write_stack;

std::vector<std::string> names(const SliceList& list) {
  std::vector<std::string> result;
  for (const auto& slice : list.slices) result.push_back(slice.name());
  return result;
}

int at(const SliceImage& slice, int x, int y) {
  return slice.format == PixelFormat::kMono8 ? slice.view().as<std::uint8_t>().at(x, y)
                                             : slice.view().as<std::uint16_t>().at(x, y);
}

TEST(SliceFiles, AreInNaturalOrder) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "slice_", ".png", 11, 5);
  const SliceList list = find_slices(scratch.path());
  EXPECT_THAT(names(list), testing::ElementsAre("slice_0.png", "slice_1.png", "slice_2.png", "slice_3.png",
                                                "slice_4.png", "slice_5.png", "slice_6.png", "slice_7.png",
                                                "slice_8.png", "slice_9.png", "slice_10.png"));
  EXPECT_EQ(list.gap, "");
  EXPECT_EQ(list.description, "slice_*.png (11 files)");
}

TEST(SliceFiles, AreNotTheOthersInTheFolder) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "scan2_", "_raw.png", 6, 3);
  write_stack(scratch.path(), "thumb", ".png", 3, 3);
  write_stack(scratch.path(), ".hidden", ".png", 9, 3);
  cv::imwrite((scratch / "truth.tiff").string(), pattern_slice(0, 0));
  cv::imwrite((scratch / "mask_1.pgm").string(), pattern_slice(0, 0));
  test::write_text(scratch / "z.txt", "0\n");
  test::write_text(scratch / "notes7.md", "0\n");
  std::filesystem::create_directory(scratch / "scan2_9_raw.png");
  EXPECT_EQ(find_slices(scratch.path()).description, "scan2_*_raw.png (6 files)");
}

TEST(SliceFiles, RefuseTwoFamiliesOfLikeSize) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "left", ".png", 5, 3);
  write_stack(scratch.path(), "right", ".png", 4, 3);
  expect_error(ErrorCode::kBadInput, {"left*.png (5 files)", "right*.png (4 files)"},
               [&] { (void)find_slices(scratch.path()); });
}

TEST(SliceFiles, RefuseTwoFilesOfOneNumber) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "a", ".png", 3, 1);
  cv::imwrite((scratch / "a01.png").string(), pattern_slice(0, 0));
  expect_error(ErrorCode::kBadInput, {"a01.png", "a1.png", "same number"}, [&] { (void)find_slices(scratch.path()); });
}

TEST(SliceFiles, RefuseAFolderWithoutAStack) {
  const ScratchDir scratch;
  expect_error(ErrorCode::kBadInput, {"no slices", "slice_000.png"}, [&] { (void)find_slices(scratch.path()); });
  expect_error(ErrorCode::kBadInput, {"no file or folder", "nowhere"}, [&] { (void)find_slices(scratch / "nowhere"); });
  cv::imwrite((scratch / "slice_0.png").string(), pattern_slice(0, 0));
  expect_error(ErrorCode::kBadInput, {"only one slice", "slice_0.png"}, [&] { (void)find_slices(scratch.path()); });
  expect_error(ErrorCode::kBadInput, {"not a TIFF with several pages"},
               [&] { (void)find_slices(scratch / "slice_0.png"); });
}

TEST(SliceFiles, TellAboutAGapInTheNumbers) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "s", ".png", 6, 1);
  std::filesystem::remove(scratch / "s3.png");
  EXPECT_EQ(find_slices(scratch.path()).gap, "s2.png is followed by s4.png");
}

TEST(SliceFiles, MayCountInTens) {
  const ScratchDir scratch;
  for (const char* name : {"z100.png", "z110.png", "z90.png"}) {
    cv::imwrite((scratch / name).string(), pattern_slice(0, 0));
  }
  const SliceList list = find_slices(scratch.path());
  EXPECT_THAT(names(list), testing::ElementsAre("z90.png", "z100.png", "z110.png"));
  EXPECT_EQ(list.gap, "");
}

TEST(SliceFiles, MayBeThePagesOfATiff) {
  const ScratchDir scratch;
  write_pages(scratch / "stack.TIF", 7, 3);
  write_stack(scratch.path(), "preview_", ".png", 2, 1);
  const SliceList list = find_slices(scratch.path());
  EXPECT_EQ(list.description, "stack.TIF (7 pages)");
  EXPECT_EQ(list.slices[6].name(), "stack.TIF page 7");
  EXPECT_EQ(find_slices(scratch / "stack.TIF").slices.size(), 7U);
}

class EveryFileType : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(EveryFileType, ReadsBackWhatWasRecorded) {
  const auto [extension, type] = GetParam();
  const ScratchDir scratch;
  write_stack(scratch.path(), "s", extension, 3, 1, type);
  const RecordedStack stack(scratch.path());
  EXPECT_EQ(stack.width(), 40);
  EXPECT_EQ(stack.height(), 30);
  EXPECT_EQ(stack.format(), CV_MAT_DEPTH(type) == CV_8U ? PixelFormat::kMono8 : PixelFormat::kMono16);
  const int tolerance = std::string(extension) == ".jpg" ? 40 : 1;  // 1: rounding of the luminance of equal channels
  const cv::Mat expected = pattern_slice(2, 1, CV_MAKETYPE(CV_MAT_DEPTH(type), 1));
  const SliceImage slice = stack.read(2);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const int level = expected.depth() == CV_8U ? expected.at<std::uint8_t>(y, x) : expected.at<std::uint16_t>(y, x);
      ASSERT_NEAR(at(slice, x, y), level, tolerance) << x << "," << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Recorded, EveryFileType,
                         testing::Values(std::tuple{".png", CV_8UC1}, std::tuple{".png", CV_16UC1},
                                         std::tuple{".png", CV_8UC3}, std::tuple{".png", CV_16UC3},
                                         std::tuple{".tiff", CV_8UC1}, std::tuple{".tif", CV_16UC1},
                                         std::tuple{".jpg", CV_8UC1}, std::tuple{".jpg", CV_8UC3},
                                         std::tuple{".pgm", CV_8UC1}, std::tuple{".pgm", CV_16UC1}));

TEST(RecordedStack, TurnsColourIntoLuminance) {
  const ScratchDir scratch;
  for (int i = 0; i < 2; ++i) {
    cv::imwrite((scratch / ("s" + std::to_string(i) + ".png")).string(),
                cv::Mat(4, 4, CV_8UC4, cv::Scalar(200, 100, 50, 7)));  // B, G, R, alpha
  }
  EXPECT_NEAR(at(RecordedStack(scratch.path()).read(0), 1, 1), 0.114 * 200 + 0.587 * 100 + 0.299 * 50, 1.0);
}

TEST(RecordedStack, ReadsTheRightPage) {
  const ScratchDir scratch;
  write_pages(scratch / "stack.tif", 5, 3);
  const RecordedStack stack(scratch / "stack.tif");
  ASSERT_EQ(stack.slices(), 5);
  EXPECT_EQ(at(stack.read(3), 7, 9), pattern_slice(3, 3).at<std::uint8_t>(9, 7));
  EXPECT_EQ(at(stack.read(0), 7, 9), pattern_slice(0, 3).at<std::uint8_t>(9, 7));
}

TEST(RecordedStack, TakesTheDepthFromThePgm) {
  const ScratchDir scratch;
  for (const char* name : {"s0.pgm", "s1.pgm"}) {
    test::write_text(scratch / name, std::string("P5\n# by hand\n2 1\n4095\n\x01\x02\x0F\xFF"));
  }
  const RecordedStack stack(scratch.path());
  EXPECT_EQ(stack.format(), PixelFormat::kMono12);
  EXPECT_EQ(at(stack.read(1), 0, 0), 0x0102);
  EXPECT_EQ(at(stack.read(1), 1, 0), 0x0FFF);
}

TEST(RecordedStack, NamesTheSliceOfAnotherSizeWithBothSizes) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "s", ".png", 3, 1);
  cv::imwrite((scratch / "s3.png").string(), pattern_slice(0, 0, CV_8UC1, 41, 30));
  cv::imwrite((scratch / "s4.png").string(), pattern_slice(0, 0, CV_16UC1));
  const RecordedStack stack(scratch.path());
  expect_error(ErrorCode::kBadInput, {"s3.png", "41 x 30", "40 x 30"}, [&] { (void)stack.read(3); });
  expect_error(ErrorCode::kBadInput, {"s4.png", "16 bit", "8 bit"}, [&] { (void)stack.read(4); });
}

TEST(RecordedStack, NamesTheSliceOfAnotherKind) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "s", ".tiff", 2, 1);
  cv::imwrite((scratch / "s2.tiff").string(), cv::Mat(30, 40, CV_32F, cv::Scalar(1)));
  write_pages(scratch / "s3.tiff", 2, 1);
  const RecordedStack stack(scratch.path());
  expect_error(ErrorCode::kBadInput, {"s2.tiff", "real or signed"}, [&] { (void)stack.read(2); });
  expect_error(ErrorCode::kBadInput, {"s3.tiff", "several pages"}, [&] { (void)stack.read(3); });
}

class ADamagedFile : public testing::TestWithParam<const char*> {};

TEST_P(ADamagedFile, IsNamedWhereverItIsCutOff) {
  const ScratchDir scratch;
  write_stack(scratch.path(), "s", GetParam(), 3, 1);
  const auto file = scratch / (std::string("s1") + GetParam());
  const std::string whole = test::read_text(file);
  const RecordedStack stack(scratch.path());
  ASSERT_NO_THROW((void)stack.read(1).view());
  for (const double fraction : {0.0, 0.01, 0.3, 0.6, 0.95}) {
    test::write_text(file, whole.substr(0, static_cast<std::size_t>(fraction * static_cast<double>(whole.size()))));
    expect_error(ErrorCode::kBadInput, {"s1", "damaged"}, [&] { (void)stack.read(1).view(); });
  }
  std::filesystem::remove(file);
  expect_error(ErrorCode::kBadInput, {"s1", "missing"}, [&] { (void)stack.read(1).view(); });
}

INSTANTIATE_TEST_SUITE_P(Recorded, ADamagedFile, testing::Values(".png", ".jpg", ".pgm", ".tiff"));

}  // namespace
}  // namespace fvd
