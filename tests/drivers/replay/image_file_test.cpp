#include "drivers/replay/image_file.hpp"

#include <cstring>
#include <functional>
#include <memory>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <tiffio.h>

#include "drivers/replay/tiff_pages.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

int level(const ImageFile& image, int x, int y, int channel = 0) {
  const auto at = static_cast<std::size_t>((y * image.width + x) * image.channels + channel);
  if (image.bytes_per_sample == 1) return std::to_integer<int>(image.samples[at]);
  std::uint16_t value = 0;
  std::memcpy(&value, &image.samples[2 * at], 2);
  return value;
}

void expect_refused(const std::function<void(ImageFile&)>& read, const std::string& reason) {
  ImageFile image;
  try {
    read(image);
    ADD_FAILURE() << "was read";
  } catch (const ImageFileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(reason));
  }
}

TEST(PgmFile, MayBeDecimal) {
  const test::ScratchDir scratch;
  test::write_text(scratch / "a.pgm", "P2 # ascii\n3 2\n# comment\n300\n0 1 2\n\n 100 200\t300\n");
  ImageFile image;
  read_pgm(scratch / "a.pgm", image);
  EXPECT_EQ(image.bytes_per_sample, 2);
  EXPECT_EQ(image.max_level, 300);
  EXPECT_EQ(level(image, 1, 0), 1);
  EXPECT_EQ(level(image, 2, 1), 300);
}

TEST(PgmFile, IsRefusedWithItsFault) {
  const test::ScratchDir scratch;
  const auto refuse = [&](const std::string& text, const std::string& reason) {
    test::write_text(scratch / "a.pgm", text);
    expect_refused([&](ImageFile& image) { read_pgm(scratch / "a.pgm", image); }, reason);
  };
  refuse("P6\n1 1\n255\nabc", "does not begin as a PGM");
  refuse("", "does not begin as a PGM");
  refuse("P5\n2 x\n255\n", "header");
  refuse("P5\n2 2\n0\n", "largest level of 0");
  refuse("P5\n2 2\n65536\n", "largest level of 65536");
  refuse("P5\n0 2\n255\n", "0 x 2");
  refuse("P5\n-1 2\n255\n", "-1 x 2");
  refuse("P5\n65535 65535\n255\n", "65535 x 65535");
  refuse("P5\n99999999999 1\n255\n", "header");
  refuse("P5\n2 2\n255\nabc", "3 of 4 bytes");
  refuse("P2\n2 1\n255\n1 256\n", "pixel 1");
  refuse("P2\n2 1\n255\n1 -1\n", "pixel 1");
  refuse("P2\n2 1\n255\n1\n", "pixel 1");
}

TEST(PngFile, LosesItsTransparencyAndKeepsItsLevels) {
  const test::ScratchDir scratch;
  cv::imwrite((scratch / "a.png").string(), cv::Mat(3, 5, CV_16UC4, cv::Scalar(1000, 20000, 65535, 7)));
  ImageFile image;
  read_png(scratch / "a.png", image);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(image.bytes_per_sample, 2);
  EXPECT_EQ(level(image, 4, 2, 0), 1000);
  EXPECT_EQ(level(image, 4, 2, 1), 20000);
  EXPECT_EQ(level(image, 4, 2, 2), 65535);
}

TEST(PngFile, OfOneBitBecomesBlackAndWhite) {
  const test::ScratchDir scratch;
  cv::imwrite((scratch / "a.png").string(), cv::Mat::eye(9, 9, CV_8U) * 255, {cv::IMWRITE_PNG_BILEVEL, 1});
  ImageFile image;
  read_png(scratch / "a.png", image);
  EXPECT_EQ(image.bytes_per_sample, 1);
  EXPECT_EQ(level(image, 8, 8), 255);
  EXPECT_EQ(level(image, 7, 8), 0);
}

TEST(AnImageFile, UsesItsMemoryAgain) {
  const test::ScratchDir scratch;
  cv::imwrite((scratch / "a.png").string(), cv::Mat(30, 50, CV_8U, cv::Scalar(1)));
  cv::imwrite((scratch / "b.jpg").string(), cv::Mat(20, 50, CV_8U, cv::Scalar(99)));
  ImageFile image;
  read_png(scratch / "a.png", image);
  const auto* memory = image.samples.data();
  read_jpeg(scratch / "b.jpg", image);
  EXPECT_EQ(image.samples.data(), memory);
  EXPECT_EQ(image.height, 20);
  EXPECT_NEAR(level(image, 3, 3), 99, 1);
}

TEST(JpegFile, IsRefusedWhereLibjpegWouldGuess) {
  const test::ScratchDir scratch;
  cv::Mat noise(64, 64, CV_8U);
  cv::randu(noise, 0, 256);
  cv::imwrite((scratch / "a.jpg").string(), noise);
  std::string bytes = test::read_text(scratch / "a.jpg");
  bytes.resize(bytes.size() / 2);
  test::write_text(scratch / "a.jpg", bytes + "\xFF\xD9");  // as a careless program would close it
  expect_refused([&](ImageFile& image) { read_jpeg(scratch / "a.jpg", image); }, "libjpeg");
}

struct TiffLayout {
  const char* name;
  std::uint16_t bits;
  std::uint16_t samples;
  std::uint16_t photometric;
  std::uint16_t planes;
  bool tiled;
};

/// For the names of the tests.
inline void PrintTo(const TiffLayout& of, std::ostream* out) { *out << of.name; }

/// The level of a sample: tells columns, rows and channels apart.
int expected_level(int x, int y, int channel, int bits) {
  return (7 * x + 3 * y + 50 * channel) * (bits == 16 ? 200 : 1) % (1 << bits);
}

void write_sample(std::vector<std::byte>& row, std::size_t i, int value, int bits) {
  if (bits == 8) {
    row[i] = static_cast<std::byte>(value);
  } else {
    const auto wide = static_cast<std::uint16_t>(value);
    std::memcpy(&row[2 * i], &wide, 2);
  }
}

constexpr int kWidth = 21;
constexpr int kHeight = 19;

void write_tiff(const std::filesystem::path& file, const TiffLayout& layout) {
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(TIFFOpen(file.c_str(), "w"), TIFFClose);
  ASSERT_NE(tiff, nullptr);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, kWidth);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, kHeight);
  TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, layout.bits);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, layout.samples);
  TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, layout.photometric);
  TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, layout.planes);
  TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  const int tile = 16;
  if (layout.tiled) {
    TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, tile);
    TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, tile);
  } else {
    TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, 4);
  }
  const bool separate = layout.planes == PLANARCONFIG_SEPARATE;
  const int planes = separate ? layout.samples : 1;
  const int together = separate ? 1 : layout.samples;
  for (int plane = 0; plane < planes; ++plane) {
    const auto block = [&](int left, int top, int width, int height) {
      std::vector<std::byte> bytes(static_cast<std::size_t>(width * height * together * layout.bits / 8));
      for (int i = 0; i < width * height * together; ++i) {
        const int x = left + i / together % width;
        const int y = top + i / together / width;
        write_sample(bytes, static_cast<std::size_t>(i), expected_level(x, y, plane + i % together, layout.bits),
                     layout.bits);
      }
      return bytes;
    };
    if (layout.tiled) {
      for (int top = 0; top < kHeight; top += tile) {
        for (int left = 0; left < kWidth; left += tile) {
          TIFFWriteTile(tiff.get(), block(left, top, tile, tile).data(), static_cast<std::uint32_t>(left),
                        static_cast<std::uint32_t>(top), 0, static_cast<std::uint16_t>(plane));
        }
      }
    } else {
      for (int y = 0; y < kHeight; ++y) {
        TIFFWriteScanline(tiff.get(), block(0, y, kWidth, 1).data(), static_cast<std::uint32_t>(y),
                          static_cast<std::uint16_t>(plane));
      }
    }
  }
}

class EveryTiffLayout : public testing::TestWithParam<TiffLayout> {};

TEST_P(EveryTiffLayout, IsReadAsItIs) {
  const TiffLayout& layout = GetParam();
  const test::ScratchDir scratch;
  write_tiff(scratch / "a.tif", layout);
  ImageFile image;
  read_tiff(scratch / "a.tif", 0, image);
  const int channels = layout.photometric == PHOTOMETRIC_RGB ? 3 : 1;
  ASSERT_EQ(image.channels, channels);
  ASSERT_EQ(image.bytes_per_sample, layout.bits / 8);
  const int white = layout.photometric == PHOTOMETRIC_MINISWHITE ? (1 << layout.bits) - 1 : 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < channels; ++c) {
        ASSERT_EQ(level(image, x, y, channels - 1 - c), expected_level(x, y, c, layout.bits) ^ white)
            << x << "," << y << " channel " << c;
      }
    }
  }
}

constexpr std::uint16_t kInterleaved = PLANARCONFIG_CONTIG;
constexpr std::uint16_t kSeparatePlanes = PLANARCONFIG_SEPARATE;
INSTANTIATE_TEST_SUITE_P(Recorded, EveryTiffLayout,
                         testing::Values(TiffLayout{"Grey8", 8, 1, PHOTOMETRIC_MINISBLACK, kInterleaved, false},
                                         TiffLayout{"Grey16", 16, 1, PHOTOMETRIC_MINISBLACK, kInterleaved, false},
                                         TiffLayout{"White16", 16, 1, PHOTOMETRIC_MINISWHITE, kInterleaved, false},
                                         TiffLayout{"GreyAlpha8", 8, 2, PHOTOMETRIC_MINISBLACK, kInterleaved, false},
                                         TiffLayout{"Rgb8", 8, 3, PHOTOMETRIC_RGB, kInterleaved, false},
                                         TiffLayout{"Rgba16", 16, 4, PHOTOMETRIC_RGB, kInterleaved, false},
                                         TiffLayout{"RgbPlanes16", 16, 3, PHOTOMETRIC_RGB, kSeparatePlanes, false},
                                         TiffLayout{"GreyTiles16", 16, 1, PHOTOMETRIC_MINISBLACK, kInterleaved, true},
                                         TiffLayout{"RgbTiles8", 8, 3, PHOTOMETRIC_RGB, kInterleaved, true},
                                         TiffLayout{"RgbPlaneTiles8", 8, 3, PHOTOMETRIC_RGB, kSeparatePlanes, true}),
                         [](const auto& layout) { return std::string(layout.param.name); });

TEST(TiffFile, HasThePagesItHas) {
  const test::ScratchDir scratch;
  cv::imwritemulti((scratch / "a.tif").string(), std::vector<cv::Mat>(3, cv::Mat(4, 4, CV_8U, cv::Scalar(5))));
  EXPECT_EQ(tiff_content(scratch / "a.tif").size(), 3);
  expect_refused([&](ImageFile& image) { read_tiff(scratch / "a.tif", 3, image); }, "libtiff");
  test::write_text(scratch / "b.tif", "not a TIFF");
  EXPECT_EQ(tiff_content(scratch / "b.tif").size(), 0);
  EXPECT_EQ(tiff_content(scratch / "missing.tif").size(), 0);
}

}  // namespace
}  // namespace fvd
