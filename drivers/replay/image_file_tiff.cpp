#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <tiffio.h>

#include "drivers/replay/image_file.hpp"

namespace fvd {

namespace {

struct TiffCloser {
  void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, TiffCloser>;

int keep_error(TIFF* /*tiff*/, void* text, const char* /*module*/, const char* format, std::va_list arguments) {
  char line[160];
  std::vsnprintf(line, sizeof line, format, arguments);
  *static_cast<std::string*>(text) = line;
  return 1;  // not to standard error as well
}

int drop_warning(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }  // of unknown tags, mostly

/// error: where the handle's errors go; must outlive it.
Tiff open_tiff(const std::filesystem::path& file, std::string& error) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &error);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), drop_warning, nullptr);
  return Tiff(TIFFOpenExt(file.c_str(), "r", options.get()));
}

/// The layout of one page.
struct Page {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t bits = 1;
  std::uint16_t samples = 1;
  std::uint16_t sample_format = SAMPLEFORMAT_UINT;
  std::uint16_t planes = PLANARCONFIG_CONTIG;
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;

  /// Whether grey levels stand in the file as they are.
  [[nodiscard]] bool plain() const {
    const bool grey = photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
    return (bits == 8 || bits == 16) && (grey || (photometric == PHOTOMETRIC_RGB && samples >= 3));
  }
  [[nodiscard]] int channels() const { return photometric == PHOTOMETRIC_RGB ? 3 : 1; }
};

Page page_of(TIFF* tiff) {
  Page page;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &page.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &page.sample_format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &page.planes);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &page.photometric);
  return page;
}

/// Copies count pixels, of in_stride samples each in the file, to one channel or to all of image; red, green, blue
/// become blue, green, red.
void put_pixels(const std::byte* in, std::size_t in_stride, std::size_t count, int first_channel, int channels,
                const ImageFile& image, std::byte* out) {
  const auto bytes = static_cast<std::size_t>(image.bytes_per_sample);
  const auto out_stride = static_cast<std::size_t>(image.channels) * bytes;
  if (in_stride * bytes == out_stride && image.channels == 1) {
    std::memcpy(out, in, count * bytes);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < channels; ++c) {
      const auto to = static_cast<std::size_t>(image.channels - 1 - (first_channel + c));
      std::memcpy(out + i * out_stride + to * bytes, in + (i * in_stride + static_cast<std::size_t>(c)) * bytes, bytes);
    }
  }
}

/// One plane: all channels of the image, or the one that this plane holds.
struct Plane {
  std::uint16_t index = 0;
  int first_channel = 0;
  int channels = 1;
  std::size_t stride = 1;  ///< samples from pixel to pixel
};

bool read_strips(TIFF* tiff, const Plane& plane, ImageFile& image) {
  std::vector<std::byte> line(static_cast<std::size_t>(TIFFScanlineSize64(tiff)));
  for (int y = 0; y < image.height; ++y) {
    if (TIFFReadScanline(tiff, line.data(), static_cast<std::uint32_t>(y), plane.index) != 1) return false;
    put_pixels(line.data(), plane.stride, static_cast<std::size_t>(image.width), plane.first_channel, plane.channels,
               image, image.row(y));
  }
  return true;
}

bool read_tiles(TIFF* tiff, const Plane& plane, ImageFile& image) {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_TILELENGTH, &height);
  std::vector<std::byte> tile(static_cast<std::size_t>(TIFFTileSize64(tiff)));
  const std::size_t row_bytes = static_cast<std::size_t>(TIFFTileRowSize64(tiff));
  const auto pixel_bytes = static_cast<std::size_t>(image.channels) * static_cast<std::size_t>(image.bytes_per_sample);
  for (std::uint32_t top = 0; top < static_cast<std::uint32_t>(image.height); top += height) {
    for (std::uint32_t left = 0; left < static_cast<std::uint32_t>(image.width); left += width) {
      if (TIFFReadTile(tiff, tile.data(), left, top, 0, plane.index) < 0) return false;
      const std::size_t columns = std::min(width, static_cast<std::uint32_t>(image.width) - left);
      const std::uint32_t rows = std::min(height, static_cast<std::uint32_t>(image.height) - top);
      for (std::uint32_t y = 0; y < rows; ++y) {
        put_pixels(tile.data() + y * row_bytes, plane.stride, columns, plane.first_channel, plane.channels, image,
                   image.row(static_cast<int>(top + y)) + left * pixel_bytes);
      }
    }
  }
  return true;
}

bool read_plain(TIFF* tiff, const Page& page, ImageFile& image) {
  image.resize(page.width, page.height, page.channels(), page.bits / 8);
  const auto read = TIFFIsTiled(tiff) != 0 ? read_tiles : read_strips;
  if (page.planes == PLANARCONFIG_SEPARATE) {
    for (int c = 0; c < image.channels; ++c) {
      if (!read(tiff, {static_cast<std::uint16_t>(c), c, 1, 1}, image)) return false;
    }
  } else if (!read(tiff, {0, 0, image.channels, page.samples}, image)) {
    return false;
  }
  if (page.photometric == PHOTOMETRIC_MINISWHITE) {
    for (std::byte& sample : image.samples) sample = ~sample;
  }
  return true;
}

/// libtiff's conversion of everything else to 8-bit red, green, blue, alpha.
bool read_converted(TIFF* tiff, const Page& page, ImageFile& image) {
  image.resize(page.width, page.height, 3, 1);
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(page.width) * page.height);
  if (TIFFReadRGBAImageOriented(tiff, page.width, page.height, pixels.data(), ORIENTATION_TOPLEFT, 1) != 1)
    return false;
  auto* out = image.samples.data();
  for (const std::uint32_t pixel : pixels) {
    *out++ = static_cast<std::byte>(TIFFGetB(pixel));
    *out++ = static_cast<std::byte>(TIFFGetG(pixel));
    *out++ = static_cast<std::byte>(TIFFGetR(pixel));
  }
  return true;
}

}  // namespace

void read_tiff(const std::filesystem::path& file, int page_index, ImageFile& image) {
  std::string error = "no such page";
  const Tiff tiff = open_tiff(file, error);
  if (!tiff || TIFFSetDirectory(tiff.get(), static_cast<tdir_t>(page_index)) != 1) {
    throw ImageFileError("libtiff: " + error);
  }
  const Page page = page_of(tiff.get());
  if (page.bits > 16 || (page.sample_format != SAMPLEFORMAT_UINT && page.sample_format != SAMPLEFORMAT_VOID)) {
    throw ImageFileError("its pixels are not 8 or 16 bit unsigned integers");
  }
  if (page.bits > 8 && !page.plain()) {
    throw ImageFileError("16 bit are read as grey or as red, green and blue only");
  }
  const bool done = page.plain() ? read_plain(tiff.get(), page, image) : read_converted(tiff.get(), page, image);
  if (!done) throw ImageFileError("libtiff: " + error);
}

int count_tiff_pages(const std::filesystem::path& file) {
  std::string error;
  const Tiff tiff = open_tiff(file, error);
  return tiff ? static_cast<int>(TIFFNumberOfDirectories(tiff.get())) : 0;
}

}  // namespace fvd
