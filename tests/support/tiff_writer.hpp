#pragma once

/// Writes TIFFs with the tags that a test wants.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <tiffio.h>

namespace fvd::test {

/// One page. Of `pixels` as they are, 8 or 16 bit unsigned or signed, or float, 1 or 3 channels.
struct TiffPageSpec {
  cv::Mat pixels;
  std::string description;
  std::uint32_t subfile_type = 0;  ///< FILETYPE_REDUCEDIMAGE, FILETYPE_MASK, FILETYPE_PAGE
  int packed_bits = 0;             ///< 10, 12 or 14: CV_16UC1 pixels written so, most significant bit first
};

inline std::vector<std::uint8_t> pack_row(const std::uint16_t* row, int width, int bits) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>((width * bits + 7) / 8));
  for (int x = 0; x < width; ++x) {
    for (int bit = 0; bit < bits; ++bit) {
      const auto at = static_cast<std::size_t>(x * bits + bit);
      if ((row[x] >> (bits - 1 - bit) & 1) != 0)
        bytes[at / 8] = static_cast<std::uint8_t>(bytes[at / 8] | 0x80U >> at % 8);
    }
  }
  return bytes;
}

/// mode: of TIFFOpen, "w", "wb" (big-endian), "w8" (BigTIFF).
inline void write_tiff(const std::filesystem::path& file, const std::vector<TiffPageSpec>& pages,
                       const char* mode = "w") {
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(TIFFOpen(file.c_str(), mode), TIFFClose);
  for (const TiffPageSpec& page : pages) {
    const int depth = page.pixels.depth();
    const int bits = page.packed_bits > 0 ? page.packed_bits : static_cast<int>(page.pixels.elemSize1() * 8);
    const bool is_signed = depth == CV_16S || depth == CV_8S || depth == CV_32S;
    TIFFSetField(tiff.get(), TIFFTAG_SUBFILETYPE, page.subfile_type);
    TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, page.pixels.cols);
    TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, page.pixels.rows);
    TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, page.pixels.channels());
    TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC,
                 page.pixels.channels() == 3                ? PHOTOMETRIC_RGB
                 : (page.subfile_type & FILETYPE_MASK) != 0 ? PHOTOMETRIC_MASK
                                                            : PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, page.pixels.rows);
    TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT,
                 depth == CV_32F || depth == CV_64F ? SAMPLEFORMAT_IEEEFP
                 : is_signed                        ? SAMPLEFORMAT_INT
                                                    : SAMPLEFORMAT_UINT);
    if (!page.description.empty()) TIFFSetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, page.description.c_str());
    for (int y = 0; y < page.pixels.rows; ++y) {
      std::vector<std::uint8_t> row(
          page.pixels.ptr(y), page.pixels.ptr(y) + static_cast<std::size_t>(page.pixels.cols) * page.pixels.elemSize());
      if (page.packed_bits > 0) row = pack_row(page.pixels.ptr<std::uint16_t>(y), page.pixels.cols, page.packed_bits);
      TIFFWriteScanline(tiff.get(), row.data(), static_cast<std::uint32_t>(y));
    }
    TIFFWriteDirectory(tiff.get());
  }
}

/// Images one after the other behind one directory, as ImageJ writes stacks above 4 GB; big-endian, 16 bit grey.
inline std::string imagej_contiguous_tiff(const std::vector<cv::Mat>& images, const std::string& description) {
  std::string file("MM\0*", 4);
  const auto put = [&file](std::uint32_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) file += static_cast<char>(value >> static_cast<unsigned>(8 * i));
  };
  const auto width = static_cast<std::uint32_t>(images.front().cols);
  const auto height = static_cast<std::uint32_t>(images.front().rows);
  const std::uint32_t text_at = 8 + 2 + 12 * 11 + 4;
  const auto text_bytes = static_cast<std::uint32_t>(description.size() + 1);
  put(8, 4);
  put(11, 2);
  const auto entry = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t count, std::uint32_t value) {
    put(tag, 2);
    put(type, 2);
    put(count, 4);
    put(type == 3 ? value << 16U : value, 4);
  };
  entry(254, 4, 1, 0);
  entry(256, 4, 1, width);
  entry(257, 4, 1, height);
  entry(258, 3, 1, 16);
  entry(259, 3, 1, 1);
  entry(262, 3, 1, 1);
  entry(270, 2, text_bytes, text_at);
  entry(273, 4, 1, text_at + text_bytes);
  entry(277, 3, 1, 1);
  entry(278, 4, 1, height);
  entry(279, 4, 1, 2 * width * height);
  put(0, 4);
  file += description + '\0';
  for (const cv::Mat& image : images) {
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) put(image.at<std::uint16_t>(y, x), 2);
    }
  }
  return file;
}

}  // namespace fvd::test
