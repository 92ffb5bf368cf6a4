#include "drivers/replay/significant_bits.hpp"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "drivers/replay/recorded_stack.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/stack_folder.hpp"
#include "tests/support/tiff_writer.hpp"

namespace fvd {
namespace {

using test::expect_error;
using test::ScratchDir;

/// Noise up to 2^bits, clipped at 2^bits - 1; times 2^shift.
cv::Mat clipped(int seed, int bits, int shift = 0) {
  cv::Mat image(30, 40, CV_16UC1);
  std::uint32_t state = 77U + static_cast<std::uint32_t>(seed);
  const std::uint32_t most = (1U << static_cast<unsigned>(bits)) - 1U;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      state = state * 1664525U + 1013904223U;  // Numerical Recipes LCG
      const std::uint32_t level = (state >> 16U) * (most + most / 8) / 65'535U;
      image.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(std::min(level, most) << static_cast<unsigned>(shift));
    }
  }
  return image;
}

void write_slices(const ScratchDir& scratch, int count, int bits, int shift) {
  for (int i = 0; i < count; ++i) {
    cv::imwrite((scratch / ("s" + std::to_string(i) + ".png")).string(), clipped(i, bits, shift));
  }
}

std::uint16_t word_at(const SliceImage& slice, int x, int y) { return slice.view().as<std::uint16_t>().at(x, y); }

int most(const SliceImage& slice) {
  const auto* const first = reinterpret_cast<const std::uint16_t*>(slice.pixels.data());
  return *std::max_element(first, first + slice.pixels.size() / 2);
}

struct Bits {
  int bits;
  int shift;
  PixelFormat format;
};

class EveryDepth : public testing::TestWithParam<Bits> {};

TEST_P(EveryDepth, IsSeenFromThePlateauOrTheZeroBits) {
  const ScratchDir scratch;
  write_slices(scratch, 7, GetParam().bits, GetParam().shift);
  const RecordedStack stack(scratch.path());
  EXPECT_EQ(stack.format(), GetParam().format);
  EXPECT_THAT(stack.list().description, testing::HasSubstr(std::to_string(GetParam().bits) + " significant bits"));
  for (int i = 0; i < 7; ++i)
    EXPECT_EQ(most(stack.read(i)), max_grey_level(GetParam().format)) << "saturated, slice " << i;
}

INSTANTIATE_TEST_SUITE_P(Cameras, EveryDepth,
                         testing::Values(Bits{10, 0, PixelFormat::kMono10}, Bits{12, 0, PixelFormat::kMono12},
                                         Bits{14, 0, PixelFormat::kMono16}, Bits{10, 6, PixelFormat::kMono10},
                                         Bits{12, 4, PixelFormat::kMono12}, Bits{14, 2, PixelFormat::kMono16}));

TEST(SignificantBits, AreAll16OfAnOrdinaryFile) {
  const ScratchDir scratch;
  write_slices(scratch, 3, 16, 0);
  const RecordedStack stack(scratch.path());
  EXPECT_EQ(stack.format(), PixelFormat::kMono16);
  EXPECT_EQ(stack.list().description, "s*.png (3 files)");
  EXPECT_EQ(word_at(stack.read(1), 5, 5), clipped(1, 16).at<std::uint16_t>(5, 5));
}

TEST(SignificantBits, AreSeenFromAPlateauInOneSliceOfMany) {
  const ScratchDir scratch;
  for (int i = 0; i < 12; ++i) {
    cv::Mat image = clipped(i, 11);
    if (i == 7) image.at<std::uint16_t>(3, 3) = 4095;
    cv::imwrite((scratch / ("s" + std::to_string(i) + ".png")).string(), image);
  }
  EXPECT_EQ(RecordedStack(scratch.path()).format(), PixelFormat::kMono12);
}

TEST(SignificantBits, AreAll16OfADarkFileWithoutAPlateau) {
  const ScratchDir scratch;
  for (int i = 0; i < 6; ++i) {
    cv::imwrite((scratch / ("s" + std::to_string(i) + ".png")).string(), cv::Mat(clipped(i, 11) + 3));
  }
  EXPECT_EQ(RecordedStack(scratch.path()).format(), PixelFormat::kMono16);
}

TEST(SignificantBits, AreWhatAPersonSays) {
  const ScratchDir scratch;
  write_slices(scratch, 3, 9, 0);
  EXPECT_EQ(RecordedStack(find_slices(scratch.path()), 12).format(), PixelFormat::kMono12);
  EXPECT_EQ(RecordedStack(find_slices(scratch.path()), 16).format(), PixelFormat::kMono16);
  const ScratchDir high;
  write_slices(high, 3, 10, 6);
  const RecordedStack stack(find_slices(high.path()), 10);
  EXPECT_EQ(word_at(stack.read(1), 5, 5), clipped(1, 10).at<std::uint16_t>(5, 5));
  const ScratchDir full;
  write_slices(full, 3, 16, 0);
  expect_error(ErrorCode::kBadInput, {"s0.png", "12 significant bits"},
               [&] { (void)RecordedStack(find_slices(full.path()), 12).slices(); });
}

TEST(SignificantBits, NameTheSliceThatHasMore) {
  const ScratchDir scratch;
  write_slices(scratch, 12, 12, 0);
  cv::imwrite((scratch / "s4.png").string(), clipped(4, 13));
  const RecordedStack stack(scratch.path());
  expect_error(ErrorCode::kBadInput, {"s4.png", "12 significant bits", "--significant-bits"},
               [&] { (void)stack.read(4); });
}

cv::Mat real_slice(int index, double least, double most) {
  cv::Mat slice;
  clipped(index, 12).convertTo(slice, CV_32F, (most - least) / 4095.0, least);
  return slice;
}

struct Range {
  double least;
  double most;
  double full;
};

class EveryRange : public testing::TestWithParam<Range> {};

TEST_P(EveryRange, OfRealNumbersIsBroughtTo16Bit) {
  const ScratchDir scratch;
  const auto [least, top, full] = GetParam();
  std::vector<test::TiffPageSpec> pages;
  for (int i = 0; i < 3; ++i) pages.push_back({real_slice(i, least, top), "", 0, 0});
  test::write_tiff(scratch / "s.tif", pages);
  const RecordedStack stack(scratch / "s.tif");
  EXPECT_EQ(stack.format(), PixelFormat::kMono16);
  const auto value = static_cast<double>(pages[2].pixels.at<float>(5, 6));
  EXPECT_NEAR(word_at(stack.read(2), 6, 5), (value - std::min(0.0, least)) / full * 65'535, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Recorded, EveryRange,
                         testing::Values(Range{0, 1, 1}, Range{0, 0.9, 1}, Range{10, 255, 255}, Range{0, 4095, 4095},
                                         Range{0, 30'000, 32'767}, Range{0, 1e6, 1e6}, Range{-0.25, 0.75, 1},
                                         Range{0, 0.01, 0.01}));

TEST(SignedSamples, AreTakenFromTheLeastOne) {
  const ScratchDir scratch;
  std::vector<test::TiffPageSpec> pages;
  for (int i = 0; i < 3; ++i) {
    cv::Mat slice;
    clipped(i, 16).convertTo(slice, CV_16S, 1.0, -32'768);
    slice.at<std::int16_t>(0, 0) = -32'768;
    pages.push_back({slice, "", 0, 0});
  }
  test::write_tiff(scratch / "s.tif", pages);
  EXPECT_NEAR(word_at(RecordedStack(scratch / "s.tif").read(1), 4, 5), clipped(1, 16).at<std::uint16_t>(5, 4), 1.0);
}

TEST(RealSamples, MustBeNumbers) {
  const ScratchDir scratch;
  std::vector<test::TiffPageSpec> pages;
  for (int i = 0; i < 3; ++i) pages.push_back({real_slice(i, 0, 1), "", 0, 0});
  pages[1].pixels.at<float>(2, 2) = std::numeric_limits<float>::quiet_NaN();
  test::write_tiff(scratch / "s.tif", pages);
  expect_error(ErrorCode::kBadInput, {"s.tif page 2", "finite"},
               [&] { (void)RecordedStack(scratch / "s.tif").slices(); });
}

class EveryPacking : public testing::TestWithParam<int> {};

TEST_P(EveryPacking, IsReadAsItIs) {
  const ScratchDir scratch;
  std::vector<test::TiffPageSpec> pages;
  for (int i = 0; i < 3; ++i) pages.push_back({clipped(i, GetParam()), "", 0, GetParam()});
  test::write_tiff(scratch / "s.tif", pages, "wb");
  const RecordedStack stack(scratch / "s.tif");
  EXPECT_EQ(stack.format(), GetParam() == 10   ? PixelFormat::kMono10
                            : GetParam() == 12 ? PixelFormat::kMono12
                                               : PixelFormat::kMono16);
  EXPECT_EQ(most(stack.read(2)), max_grey_level(stack.format()));
  const int lost = significant_bits(stack.format()) - GetParam();
  EXPECT_EQ(word_at(stack.read(2), 39, 29) >> lost, pages[2].pixels.at<std::uint16_t>(29, 39));
}

INSTANTIATE_TEST_SUITE_P(Recorded, EveryPacking, testing::Values(10, 12, 14));

TEST(ContiguousTiff, IsReadImageByImage) {
  const ScratchDir scratch;
  const std::vector<cv::Mat> images{clipped(0, 16), clipped(1, 16), clipped(2, 16), clipped(3, 16)};
  const std::string whole =
      test::imagej_contiguous_tiff(images, "ImageJ=1.53t\nimages=4\nslices=4\nunit=micron\nspacing=10.0\n");
  test::write_text(scratch / "s.tif", whole);
  const RecordedStack stack(scratch / "s.tif");
  ASSERT_EQ(stack.slices(), 4);
  EXPECT_EQ(stack.list().z_um, (std::vector<double>{0, 10, 20, 30}));
  EXPECT_EQ(stack.list().used_pages, 4);
  EXPECT_TRUE(stack.list().ignored_pages.empty());
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(word_at(stack.read(i), 39, 29), images[static_cast<std::size_t>(i)].at<std::uint16_t>(29, 39)) << i;
  }
  test::write_text(scratch / "s.tif", whole.substr(0, whole.size() - 1));
  expect_error(ErrorCode::kBadInput, {"s.tif", "incomplete"}, [&] { (void)RecordedStack(scratch / "s.tif").slices(); });
}

TEST(BmpFile, IsReadGreyAndInColour) {
  const ScratchDir scratch;
  test::write_stack(scratch / "grey", "s", ".bmp", 3, 1.0, CV_8UC1);
  test::write_stack(scratch / "colour", "s", ".BMP", 3, 1.0, CV_8UC3);
  const cv::Mat expected = test::pattern_slice(2, 1.0);
  const RecordedStack grey(scratch / "grey");
  EXPECT_FALSE(grey.colour());
  EXPECT_EQ(grey.read(2).view().as<std::uint8_t>().at(38, 28), expected.at<std::uint8_t>(28, 38));
  const RecordedStack colour(scratch / "colour");
  EXPECT_TRUE(colour.colour());
  EXPECT_NEAR(colour.read(2).view().as<std::uint8_t>().at(38, 28), expected.at<std::uint8_t>(28, 38), 1);
  const std::string whole = test::read_text(scratch / "grey/s1.bmp");
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{20}, whole.size() / 2}) {
    test::write_text(scratch / "grey/s1.bmp", whole.substr(0, bytes));
    expect_error(ErrorCode::kBadInput, {"s1.bmp", "damaged"}, [&] { (void)grey.read(1); });
  }
}

}  // namespace
}  // namespace fvd
