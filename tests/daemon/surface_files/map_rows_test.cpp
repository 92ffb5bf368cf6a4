#include "daemon/surface_files/map_rows.hpp"

#include <cmath>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <tiffio.h>

#include "daemon/export/gsf.hpp"
#include "daemon/export/height_tiff.hpp"
#include "daemon/export/image_png.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/surface_files/png_rows.hpp"
#include "daemon/surface_files/result_folder.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/surface_files/sample_surface.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;

Plane<float> all_rows(const MapRows& map) {
  const GridSize size = map.size();
  Plane<float> plane = Plane<float>::unset(size.width, size.height);
  for (int y = 0; y < size.height; ++y) map.read(0, y, size.width, plane.row(y));
  return plane;
}

/// A TIFF as another program might write it: samples of either width, any strips, either byte order.
void write_foreign_tiff(const std::filesystem::path& path, const Plane<float>& plane, bool wide, int compression,
                        const char* mode) {
  TIFF* tiff = TIFFOpen(path.c_str(), mode);
  ASSERT_NE(tiff, nullptr);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, plane.width());
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, plane.height());
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, wide ? 64 : 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
  for (int y = 0; y < plane.height(); ++y) {
    std::vector<double> doubles(plane.row(y), plane.row(y) + plane.width());
    std::vector<float> floats(plane.row(y), plane.row(y) + plane.width());
    void* row = wide ? static_cast<void*>(doubles.data()) : static_cast<void*>(floats.data());
    ASSERT_EQ(TIFFWriteScanline(tiff, row, static_cast<std::uint32_t>(y), 0), 1);
  }
  TIFFClose(tiff);
}

TEST(MapRows, AreThoseOfEveryFormatOfHeights) {
  for (const std::string format : {"tiff", "gsf", "sdf", "x3p"}) {
    SCOPED_TRACE(format);
    const ScratchDir scratch;
    ResultData data = test::sample_result();
    data.exports = {format};
    write_result(scratch / "job", data);

    const auto rows = open_map_rows(heights_file(scratch / "job"));

    test::expect_same_heights(all_rows(*rows), data.map.height_m);
    EXPECT_EQ(rows->bytes() == 0, format == "tiff" || format == "gsf") << "read where the points stand";
  }
}

TEST(MapRows, AreReadInPart) {
  const ScratchDir scratch;
  const Surface surface = test::sample_surface();
  test::write_text(scratch / "a.tiff", encode_height_tiff(surface.height_m, {"fvd", "", {}, {}}));
  test::write_text(scratch / "a.gsf", encode_gsf(surface.height_m, {"t", 0.5, 0.5, {}}));
  for (const char* name : {"a.tiff", "a.gsf"}) {
    const auto rows = open_map_rows(scratch / name);
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 7; ++x) {
        std::vector<float> piece(static_cast<std::size_t>(7 - x), -1.0F);
        rows->read(x, y, 7 - x, piece.data());
        for (int i = 0; i < 7 - x; ++i) {
          const float point = surface.height_m.at(x + i, y);
          const float got = piece[static_cast<std::size_t>(i)];
          EXPECT_TRUE(std::isnan(point) ? std::isnan(got) : got == point) << name << " " << x + i << ", " << y;
        }
      }
    }
  }
}

TEST(MapRows, AreReadFromTiffsOfOthers) {
  const ScratchDir scratch;
  const Surface surface = test::sample_surface();
  for (const bool wide : {false, true}) {
    for (const char* mode : {"wl", "wb", "w8"}) {
      SCOPED_TRACE(std::string(mode) + (wide ? " 64 bit" : " 32 bit"));
      write_foreign_tiff(scratch / "plain.tiff", surface.height_m, wide, COMPRESSION_NONE, mode);
      write_foreign_tiff(scratch / "packed.tiff", surface.height_m, wide, COMPRESSION_LZW, mode);

      const auto plain = open_map_rows(scratch / "plain.tiff");
      const auto packed = open_map_rows(scratch / "packed.tiff");

      test::expect_same_heights(all_rows(*plain), surface.height_m);
      test::expect_same_heights(all_rows(*packed), surface.height_m);
      EXPECT_EQ(plain->bytes(), 0U);
      EXPECT_EQ(packed->bytes(), 7U * 5U * 4U);
      EXPECT_EQ(open_tiff_rows(scratch / "packed.tiff"), nullptr);
    }
  }
}

TEST(MapRows, HaveNoInfinities) {
  const ScratchDir scratch;
  Plane<float> plane(3, 1, 1e-6F);
  plane.at(0, 0) = std::numeric_limits<float>::infinity();
  plane.at(2, 0) = -std::numeric_limits<float>::infinity();
  test::write_text(scratch / "a.tiff", encode_height_tiff(plane, {"fvd", "", {}, {}}));
  test::write_text(scratch / "a.gsf", encode_gsf(plane, {"t", 0.5, 0.5, {}}));
  for (const char* name : {"a.tiff", "a.gsf"}) {
    const Plane<float> read = all_rows(*open_map_rows(scratch / name));
    EXPECT_TRUE(std::isnan(read.at(0, 0)));
    EXPECT_EQ(read.at(1, 0), 1e-6F);
    EXPECT_TRUE(std::isnan(read.at(2, 0)));
  }
}

TEST(MapRows, AreRefusedWhereTheFileIsNone) {
  const ScratchDir scratch;
  for (const std::string content : {"", "II*", "MM", "Gwyddion", "Gwyddion Simple Field 1.0\n", "PK", "x,y"}) {
    test::write_text(scratch / "a", content);
    FVD_EXPECT_ERROR(kSurfaceFile, (void)open_map_rows(scratch / "a"));
  }
  FVD_EXPECT_ERROR(kSurfaceFile, (void)open_map_rows(scratch / "none"));
  FVD_EXPECT_ERROR(kSurfaceFile, (void)open_map_rows(scratch.path()));
}

TEST(MapRows, EndWithAnErrorWhereTheFileBecomesShorter) {
  const ScratchDir scratch;
  const Plane<float> plane(100, 100, 1e-6F);
  test::write_text(scratch / "a.tiff", encode_height_tiff(plane, {"fvd", "", {}, {}}));
  const auto rows = open_map_rows(scratch / "a.tiff");
  std::vector<float> row(100);
  rows->read(0, 99, 100, row.data());

  std::filesystem::resize_file(scratch / "a.tiff", 1000);

  EXPECT_NO_THROW(rows->read(0, 0, 100, row.data()));
  FVD_EXPECT_ERROR(kSurfaceFile, rows->read(0, 99, 100, row.data()));
}

TEST(PngRows, AreTheSamplesAsTheyAre) {
  const ScratchDir scratch;
  Plane<std::uint8_t> narrow(3, 2, 0);
  Plane<std::uint16_t> wide(3, 2, 0);
  narrow.at(2, 0) = 200;
  wide.at(0, 1) = 16384;
  wide.at(2, 1) = 65535;
  test::write_text(scratch / "narrow.png", encode_image_png(image_view(narrow.view(), PixelFormat::kMono8)));
  test::write_text(scratch / "wide.png", encode_image_png(image_view(wide.view(), PixelFormat::kMono16)));

  const Plane<float> bytes = all_rows(*open_png_rows(scratch / "narrow.png"));
  const Plane<float> words = all_rows(*open_png_rows(scratch / "wide.png"));

  EXPECT_EQ(bytes.at(2, 0), 200.0F);
  EXPECT_EQ(bytes.at(0, 1), 0.0F);
  EXPECT_EQ(words.at(0, 1), 16384.0F);
  EXPECT_EQ(words.at(2, 1), 65535.0F);
  EXPECT_EQ(png_size(scratch / "wide.png").width, 3);
  EXPECT_EQ(png_size(scratch / "wide.png").height, 2);
}

TEST(PngRows, OfColoursAreTheirBrightness) {
  const ScratchDir scratch;
  ResultData data = test::sample_result();
  data.map.colour = Plane<std::uint8_t>(3 * 6, 3, 0);
  data.map.colour.at(0, 0) = 100;      // blue of the first point
  data.map.colour.at(3 + 1, 0) = 100;  // green of the second
  data.map.colour.at(6 + 2, 0) = 100;  // red of the third
  data.exports = {"texture.png"};
  write_result(scratch / "job", data);

  const Plane<float> grey = all_rows(*open_png_rows(scratch / "job" / "texture.png"));

  ASSERT_EQ(grey.width(), 6);
  EXPECT_NEAR(grey.at(0, 0), 11.4, 1e-4);
  EXPECT_NEAR(grey.at(1, 0), 58.7, 1e-4);
  EXPECT_NEAR(grey.at(2, 0), 29.9, 1e-4);
}

TEST(PngRows, AreRefusedWhereTheFileIsNone) {
  const ScratchDir scratch;
  const Plane<std::uint8_t> image(60, 50, 7);
  const std::string whole = encode_image_png(image_view(image.view(), PixelFormat::kMono8));
  for (const std::string& content :
       {std::string(), std::string(100, 'x'), whole.substr(0, 20), whole.substr(0, whole.size() / 2)}) {
    test::write_text(scratch / "a.png", content);
    FVD_EXPECT_ERROR(kSurfaceFile, (void)open_png_rows(scratch / "a.png"));
  }
  test::write_text(scratch / "a.png", whole.substr(0, 20));
  FVD_EXPECT_ERROR(kSurfaceFile, (void)png_size(scratch / "a.png"));
  FVD_EXPECT_ERROR(kSurfaceFile, (void)png_size(scratch / "none.png"));
}

TEST(PlainFiles, AreNoLinks) {
  const ScratchDir scratch;
  test::write_text(scratch / "file", "x");
  std::filesystem::create_symlink(scratch / "file", scratch / "height.tiff");

  EXPECT_TRUE(is_plain_file(scratch / "file"));
  EXPECT_FALSE(is_plain_file(scratch / "height.tiff"));
  EXPECT_FALSE(is_plain_file(scratch.path()));
  EXPECT_FALSE(is_plain_file(scratch / "none"));
  EXPECT_EQ(heights_file(scratch.path()), "");
  test::write_text(scratch / "height.x3p", "x");
  EXPECT_EQ(heights_file(scratch.path()), scratch / "height.x3p");
  test::write_text(scratch / "height.gsf", "x");
  EXPECT_EQ(heights_file(scratch.path()), scratch / "height.gsf") << "the first that is there";
  EXPECT_EQ(sigma_file(scratch.path()), "");
}

}  // namespace
}  // namespace fvd
