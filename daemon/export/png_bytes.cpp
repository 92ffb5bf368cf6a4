#include "daemon/export/png_bytes.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <new>
#include <vector>

#include <png.h>
#include <zlib.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

/// libpng's writer with what it allocated, its last error and the bytes so far.
class PngWriter {
 public:
  PngWriter() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, nullptr)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
    png_set_write_fn(png_, this, on_bytes, nullptr);
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  /// Throws Error kInternal for an error of libpng, which leaves action by longjmp: action may hold nothing that has a
  /// destructor.
  template <typename Action>
  void call(const Action& action) {
    if (setjmp(png_jmpbuf(png_)) != 0) throw Error(ErrorCode::kInternal, error_);  // NOLINT(cert-err52-cpp): libpng
    action(png_, info_);
  }

  std::string bytes;

 private:
  [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
    auto& self = *static_cast<PngWriter*>(png_get_error_ptr(png));
    std::snprintf(self.error_, sizeof self.error_, "libpng could not encode an image: %s", text);
    png_longjmp(png, 1);
  }
  static void on_bytes(png_structp png, png_bytep data, std::size_t size) {
    static_cast<PngWriter*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
  }

  png_structp png_;
  png_infop info_ = nullptr;
  char error_[160] = "";
};

constexpr int kSampledRow = 16;           ///< one row of so many tells what the image is like
constexpr double kLittleGain_bits = 7.8;  ///< of 8: what noise leaves to gain is not worth the time

/// Bits a byte that the differences of neighbours take, by how often each value occurs.
double bits_a_byte(const cv::Mat& image) {
  const std::size_t pixel = image.elemSize();
  std::array<std::size_t, 256> counts{};
  std::size_t total = 0;
  for (int y = 0; y < image.rows; y += kSampledRow) {
    const std::uint8_t* row = image.ptr(y);
    const std::size_t bytes = static_cast<std::size_t>(image.cols) * pixel;
    for (std::size_t i = pixel; i < bytes; ++i) ++counts[static_cast<std::uint8_t>(row[i] - row[i - pixel])];
    total += bytes - pixel;
  }
  double bits = 0.0;
  for (const std::size_t count : counts) {
    if (count == 0) continue;
    const double share = static_cast<double>(count) / static_cast<double>(total);
    bits -= share * std::log2(share);
  }
  return bits;
}

}  // namespace

std::string png_bytes(const cv::Mat& image) {
  PngWriter writer;
  writer.bytes.reserve(image.total() * image.elemSize());  // what noise needs; it does not compress
  std::vector<png_const_bytep> rows;
  for (int y = 0; y < image.rows; ++y) rows.push_back(image.ptr(y));
  const bool wide = image.elemSize1() == 2;
  const bool stored = bits_a_byte(image) > kLittleGain_bits;
  const auto size = [](int side) { return static_cast<png_uint_32>(side); };
  writer.call([&](png_structp png, png_infop info) {
    png_set_IHDR(png, info, size(image.cols), size(image.rows), wide ? 16 : 8,
                 image.channels() == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // A camera's noise leaves nothing to find: the search for repeats takes 2.4 times as long for a file of the same
    // size.
    png_set_filter(png, PNG_FILTER_TYPE_BASE, stored ? PNG_FILTER_NONE : PNG_FILTER_SUB);
    png_set_compression_level(png, stored ? Z_NO_COMPRESSION : Z_BEST_SPEED);
    png_set_compression_strategy(png, Z_RLE);
    png_write_info(png, info);
    png_set_bgr(png);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
    for (const png_const_bytep row : rows) png_write_row(png, row);
    png_write_end(png, info);
  });
  return std::move(writer.bytes);
}

}  // namespace fvd
