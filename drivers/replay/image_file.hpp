#pragma once

/// Decoding of the image files in which slices are recorded, without gamma or scaling of grey levels.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace fvd {

/// The pixels of a file. Samples of 16 bit, and real numbers, are in the machine's byte order.
struct ImageFile {
  int width = 0;
  int height = 0;
  int channels = 1;                ///< 1 grey, 3 blue, green, red; transparency is dropped
  int bytes_per_sample = 1;        ///< 1 or 2; 4: float, in the file's own range
  int max_level = 0;               ///< largest grey level that the file declares; 0: it declares none
  std::vector<std::byte> samples;  ///< shape [height][width][channels], rows contiguous; memory is reused

  /// Throws ImageFileError for a size that no camera has: a side below 1 or above 65 535 pixels, or more than 2^28
  /// pixels.
  static void check_size(std::int64_t width, std::int64_t height);
  /// Allocates the samples. Throws as check_size().
  void resize(std::int64_t new_width, std::int64_t new_height, int new_channels, int new_bytes_per_sample);

  [[nodiscard]] std::size_t row_bytes() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels) *
           static_cast<std::size_t>(bytes_per_sample);
  }
  [[nodiscard]] std::byte* row(int y) { return samples.data() + row_bytes() * static_cast<std::size_t>(y); }
};

/// Reason why a file could not be read; without the file's name, which the caller adds.
class ImageFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// All read into `image`, whose memory they reuse, and throw ImageFileError if the file is missing, truncated, damaged
// or of another kind. The content of `image` after an error is undefined. context: thread-safe for different images.

/// Portable graymap, binary or in decimal numbers, 8 or 16 bit (netpbm's pgm(5), of 2013). Of several images in one
/// file the first.
void read_pgm(const std::filesystem::path& file, ImageFile& image);

/// PNG of any depth and colour type (ISO/IEC 15948:2004); below 8 bit and palettes become 8 bit.
void read_png(const std::filesystem::path& file, ImageFile& image);

/// JPEG, grey or colour. Data that libjpeg would fill in or guess is an error.
void read_jpeg(const std::filesystem::path& file, ImageFile& image);

/// BMP, uncompressed (BITMAPINFOHEADER and its successors) of 1, 4, 8, 24 or 32 bits; grey if its palette is.
void read_bmp(const std::filesystem::path& file, ImageFile& image);

/// One directory of a TIFF (TIFF 6.0), 0-based: grey or colour of 8 or 16 bit unsigned, packed 9 to 15 bits, and as
/// float signed, 32-bit and real samples; strips or tiles. Other encodings of 8 bits and below (palette, YCbCr,
/// bilevel) become 8-bit colour.
void read_tiff(const std::filesystem::path& file, int page, ImageFile& image);

/// One image, 0-based, of those that stand one after the other behind the only directory of a TIFF: ImageJ writes
/// stacks above 4 GB so. Samples as read_tiff() has them, of whole bytes and uncompressed.
void read_contiguous_tiff(const std::filesystem::path& file, int index, ImageFile& image);

}  // namespace fvd
