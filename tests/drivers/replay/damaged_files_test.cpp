/// Files whose headers and descriptions tell of more than there is: refused with a reason, before memory is asked for.

#include <limits>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include "drivers/replay/image_file.hpp"
#include "drivers/replay/page_description.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

constexpr std::size_t kLittle_bytes = 1 << 20;

template <typename Read>
std::string refusal(Read&& read, ImageFile& image) {
  try {
    read(image);
  } catch (const ImageFileError& error) {
    return error.what();
  }
  return "it was read";
}

TEST(ADamagedPgm, TakesNoMemoryForPixelsThatAreNotThere) {
  const test::ScratchDir scratch;
  for (const std::string text : {"P5 65535 4096 65535\n", "P5 65535 4096 65535", "P2 65535 4096 65535\n1 2 3"}) {
    test::write_text(scratch / "a.pgm", text);
    ImageFile image;
    EXPECT_THAT(refusal([&](ImageFile& into) { read_pgm(scratch / "a.pgm", into); }, image),
                HasSubstr("it ends after"));
    EXPECT_LT(image.samples.capacity(), kLittle_bytes);
  }
}

TEST(ADamagedBmp, TakesNoMemoryForPixelsThatAreNotThere) {
  const test::ScratchDir scratch;
  std::string text("BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\xFF\xFF\0\0\0\x10\0\0\1\0\x18\0", 30);
  text.resize(54, '\0');
  test::write_text(scratch / "a.bmp", text);
  ImageFile image;
  EXPECT_THAT(refusal([&](ImageFile& into) { read_bmp(scratch / "a.bmp", into); }, image), HasSubstr("last row"));
  EXPECT_LT(image.samples.capacity(), kLittle_bytes);
}

/// A TIFF of 4 x 4 pixels with these samples a pixel, and tiles of this side or none.
void write_tiff(const std::filesystem::path& file, int samples, std::uint32_t tile) {
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(TIFFOpen(file.c_str(), "w"), TIFFClose);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, samples > 1 ? 65'535 : 4);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, 4);
  TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 64);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, samples);
  TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  if (tile > 0) {
    TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, tile);
    TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, tile);
  } else {
    TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, 1);
  }
  TIFFWriteCheck(tiff.get(), tile > 0 ? 1 : 0, "test");
  TIFFWriteDirectory(tiff.get());
}

TEST(ADamagedTiff, TakesNoMemoryForRowsAndTilesThatNoPictureHas) {
  const test::ScratchDir scratch;
  ImageFile image;
  write_tiff(scratch / "tiles.tif", 1, 1U << 20U);
  EXPECT_THAT(refusal([&](ImageFile& into) { read_tiff(scratch / "tiles.tif", 0, into); }, image),
              HasSubstr("tiles of"));
  write_tiff(scratch / "rows.tif", 65'000, 0);
  EXPECT_THAT(refusal([&](ImageFile& into) { read_tiff(scratch / "rows.tif", 0, into); }, image), HasSubstr("rows or"));
  EXPECT_THAT(refusal([&](ImageFile& into) { read_contiguous_tiff(scratch / "rows.tif", 1, into); }, image),
              HasSubstr("rows or"));
}

TEST(ADamagedDescriptionByImageJ, IsRefused) {
  for (const std::string counts : {"images=2000000000\n", "images=2000000000\nslices=2000000000\n",
                                   "images=2\nchannels=2147483647\nslices=2147483647\nframes=2147483647\n"}) {
    const auto told = read_imagej_description("ImageJ=1.53t\n" + counts);
    ASSERT_TRUE(told);
    EXPECT_THAT(told->problem, HasSubstr("more than a million")) << counts;
    EXPECT_TRUE(told->pages.empty());
  }
}

std::string plain_ome(const std::string& sizes, const std::string& content) {
  return "<OME><Image><Pixels DimensionOrder=\"XYZCT\" " + sizes + ">" + content + "</Pixels></Image></OME>";
}

std::string repeated(int times, const std::string& text) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(ADamagedDescriptionInOme, IsRefusedWhereItsElementsTellOfTooManyPages) {
  const auto told = read_ome_description(plain_ome("SizeZ=\"1000000\"", repeated(2000, "<TiffData/>")), "a.tif", 1);
  ASSERT_TRUE(told);
  EXPECT_THAT(told->problem, HasSubstr("more than a million pages"));
}

TEST(ADamagedDescriptionInOme, MayHaveChannelsOfAnySize) {
  const auto told = read_ome_description(
      plain_ome("SizeC=\"2\"", repeated(3, "<Channel SamplesPerPixel=\"2147483647\"/>") + "<TiffData/>"), "a.tif", 1);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->channels, 2);
}

TEST(ADamagedDescriptionInOme, HasNoPositionThatIsNoNumber) {
  const std::string plane = "<Plane TheZ=\"0\" TheC=\"0\" TheT=\"0\" PositionZUnit=\"m\" PositionZ=\"";
  for (const std::string position : {"inf", "nan", "1e308"}) {
    const auto told = read_ome_description(plain_ome("", "<TiffData/>" + plane + position + "\"/>"), "a.tif", 1);
    ASSERT_TRUE(told);
    ASSERT_EQ(told->pages.size(), 1U);
    EXPECT_FALSE(told->pages[0].z_um) << position;
  }
}

// A look at every page for every plane would take an hour.
TEST(ADamagedDescriptionInOme, MayHaveAMillionPagesAndManyPlanes) {
  const std::string planes =
      repeated(20'000, "<Plane TheZ=\"7\" TheC=\"0\" TheT=\"0\" PositionZUnit=\"um\" PositionZ=\"3\"/>");
  const auto told = read_ome_description(plain_ome("SizeZ=\"1000000\"", "<TiffData/>" + planes), "a.tif", 1);
  ASSERT_TRUE(told);
  ASSERT_EQ(told->pages.size(), 1'000'000U);
  EXPECT_EQ(told->pages[7].z_um, 3.0);
}

}  // namespace
}  // namespace fvd
