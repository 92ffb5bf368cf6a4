#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <png.h>

#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

/// libpng's reader with what it allocated, and its last error.
class PngReader {
 public:
  PngReader() : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// Throws ImageFileError for an error of libpng, which leaves action by longjmp: action may hold nothing that has a
  /// destructor.
  template <typename Action>
  void call(const Action& action) {
    if (setjmp(png_jmpbuf(png_)) != 0) throw ImageFileError(error_);  // NOLINT(cert-err52-cpp): libpng's way
    action(png_, info_);
  }

 private:
  [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
    auto& self = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(self.error_, sizeof self.error_, "libpng: %s", text);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp /*png*/, png_const_charp /*text*/) {}  // about side information: not of pixels

  png_structp png_;
  png_infop info_ = nullptr;
  char error_[160] = "";
};

struct FileCloser {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

}  // namespace

void read_png(const std::filesystem::path& file, ImageFile& image) {
  const std::unique_ptr<std::FILE, FileCloser> stream(std::fopen(file.c_str(), "rbe"));
  if (!stream) throw ImageFileError(std::strerror(errno));
  PngReader reader;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  int channels = 0;
  int depth = 0;
  reader.call([&](png_structp png, png_infop info) {
    png_init_io(png, stream.get());
    png_read_info(png, info);
    png_set_expand(png);  // palette and fewer than 8 bit
    png_set_strip_alpha(png);
    png_set_bgr(png);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    width = png_get_image_width(png, info);
    height = png_get_image_height(png, info);
    channels = png_get_channels(png, info);
    depth = png_get_bit_depth(png, info);
  });
  image.resize(width, height, channels, depth / 8);
  std::vector<png_bytep> rows;
  for (int y = 0; y < image.height; ++y) rows.push_back(reinterpret_cast<png_bytep>(image.row(y)));
  reader.call([&](png_structp png, png_infop info) {
    png_read_image(png, rows.data());
    png_read_end(png, info);
  });
}

}  // namespace fvd
