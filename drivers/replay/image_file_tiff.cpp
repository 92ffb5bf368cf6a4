#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/replay/image_file.hpp"
#include "drivers/replay/tiff_handle.hpp"
#include "drivers/replay/tiff_samples.hpp"

namespace fvd {

namespace {

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
  TiffSamples samples;

  /// Puts count pixels of one row. spread: memory that is reused.
  void put(const std::byte* in, std::size_t count, std::vector<std::byte>& spread, const ImageFile& image,
           std::byte* out) const {
    if (!samples.plain()) {
      samples.spread(in, count * stride, spread);
      in = spread.data();
    }
    put_pixels(in, stride, count, first_channel, channels, image, out);
  }
};

/// Memory for a row or a tile of the file; 0 bytes is libtiff's word for a size beyond all numbers. Throws
/// ImageFileError for more than a picture has: a damaged tag must not ask for all memory.
std::vector<std::byte> buffer_of(std::uint64_t bytes) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28U;
  if (bytes == 0 || bytes > kMostBytes) {
    throw ImageFileError("its rows or tiles of " + std::to_string(bytes) + " bytes are not those of a picture");
  }
  return std::vector<std::byte>(static_cast<std::size_t>(bytes));
}

bool read_strips(TIFF* tiff, const Plane& plane, ImageFile& image) {
  std::vector<std::byte> line = buffer_of(TIFFScanlineSize64(tiff));
  std::vector<std::byte> spread;
  for (int y = 0; y < image.height; ++y) {
    if (TIFFReadScanline(tiff, line.data(), static_cast<std::uint32_t>(y), plane.index) != 1) return false;
    plane.put(line.data(), static_cast<std::size_t>(image.width), spread, image, image.row(y));
  }
  return true;
}

bool read_tiles(TIFF* tiff, const Plane& plane, ImageFile& image) {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_TILELENGTH, &height);
  std::vector<std::byte> tile = buffer_of(TIFFTileSize64(tiff));
  std::vector<std::byte> spread;
  const std::size_t row_bytes = static_cast<std::size_t>(TIFFTileRowSize64(tiff));
  const auto pixel_bytes = static_cast<std::size_t>(image.channels) * static_cast<std::size_t>(image.bytes_per_sample);
  for (std::uint32_t top = 0; top < static_cast<std::uint32_t>(image.height); top += height) {
    for (std::uint32_t left = 0; left < static_cast<std::uint32_t>(image.width); left += width) {
      if (TIFFReadTile(tiff, tile.data(), left, top, 0, plane.index) < 0) return false;
      const std::size_t columns = std::min(width, static_cast<std::uint32_t>(image.width) - left);
      const std::uint32_t rows = std::min(height, static_cast<std::uint32_t>(image.height) - top);
      for (std::uint32_t y = 0; y < rows; ++y) {
        plane.put(tile.data() + y * row_bytes, columns, spread, image,
                  image.row(static_cast<int>(top + y)) + left * pixel_bytes);
      }
    }
  }
  return true;
}

/// White is 0: the levels are turned about.
void invert(const TiffSamples& samples, ImageFile& image) {
  if (samples.bytes() == static_cast<int>(sizeof(float))) {
    for (std::size_t i = 0; i < image.samples.size(); i += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, &image.samples[i], sizeof value);
      value = -value;
      std::memcpy(&image.samples[i], &value, sizeof value);
    }
    return;
  }
  for (std::byte& sample : image.samples) sample = ~sample;
  if (samples.max_level() == 0) return;
  for (std::size_t i = 0; i < image.samples.size(); i += 2) {  // the bits above a packed sample
    std::uint16_t value = 0;
    std::memcpy(&value, &image.samples[i], 2);
    value = static_cast<std::uint16_t>(value & static_cast<unsigned>(samples.max_level()));
    std::memcpy(&image.samples[i], &value, 2);
  }
}

bool read_direct(TIFF* tiff, const TiffPage& page, ImageFile& image) {
  const TiffSamples samples(page);
  image.resize(page.width, page.height, page.channels(), samples.bytes());
  image.max_level = samples.max_level();
  const auto read = TIFFIsTiled(tiff) != 0 ? read_tiles : read_strips;
  if (page.planes == PLANARCONFIG_SEPARATE) {
    for (int c = 0; c < image.channels; ++c) {
      if (!read(tiff, {static_cast<std::uint16_t>(c), c, 1, 1, samples}, image)) return false;
    }
  } else if (!read(tiff, {0, 0, image.channels, page.samples, samples}, image)) {
    return false;
  }
  if (page.photometric == PHOTOMETRIC_MINISWHITE) invert(samples, image);
  return true;
}

/// libtiff's conversion of everything else to 8-bit red, green, blue, alpha.
bool read_converted(TIFF* tiff, const TiffPage& page, ImageFile& image) {
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

/// Whether samples can be taken from the file as they are. Throws ImageFileError if the page cannot be read at all.
bool is_direct(const TiffPage& page) {
  const bool usual = page.sample_format == SAMPLEFORMAT_UINT || page.sample_format == SAMPLEFORMAT_VOID;
  const bool direct = page.direct() && TiffSamples(page).readable();
  if (!direct && (page.bits > 8 || !usual)) {
    throw ImageFileError("samples of " + std::to_string(page.bits) +
                         " bits are read as grey or as red, green and blue only, unsigned of 8 to 16 or 32 bits, "
                         "signed of 8, 16 or 32, real of 32 or 64");
  }
  return direct;
}

}  // namespace

void read_tiff(const std::filesystem::path& file, int page_index, ImageFile& image) {
  std::string error = "no such page";
  const Tiff tiff = open_tiff(file, error);
  if (!tiff || TIFFSetDirectory(tiff.get(), static_cast<tdir_t>(page_index)) != 1) {
    throw ImageFileError("libtiff: " + error);
  }
  const TiffPage page = page_of(tiff.get());
  const bool done = is_direct(page) ? read_direct(tiff.get(), page, image) : read_converted(tiff.get(), page, image);
  if (!done) throw ImageFileError("libtiff: " + error);
}

void read_contiguous_tiff(const std::filesystem::path& file, int index, ImageFile& image) {
  std::string error = "it is no TIFF";
  const Tiff tiff = open_tiff(file, error);
  const std::uint64_t* offsets = nullptr;
  if (!tiff || TIFFGetField(tiff.get(), TIFFTAG_STRIPOFFSETS, &offsets) != 1) {
    throw ImageFileError("libtiff: " + error);
  }
  const TiffPage page = page_of(tiff.get());
  const TiffSamples samples(page);
  if (!is_direct(page) || page.bits % 8 != 0) throw ImageFileError("its pixels are not whole bytes");
  image.resize(page.width, page.height, page.channels(), samples.bytes());
  const Plane plane{0, 0, image.channels, page.samples, samples};
  const std::size_t row_samples = std::size_t{page.width} * page.samples;
  std::vector<std::byte> line = buffer_of(row_samples * (page.bits / 8U));
  std::vector<std::byte> spread;
  std::ifstream stream(file, std::ios::binary);
  const std::uint64_t image_bytes = std::uint64_t{line.size()} * page.height;
  stream.seekg(static_cast<std::streamoff>(offsets[0] + image_bytes * static_cast<std::uint64_t>(index)));
  for (int y = 0; y < image.height; ++y) {
    if (!stream.read(reinterpret_cast<char*>(line.data()), static_cast<std::streamsize>(line.size()))) {
      throw ImageFileError("it ends before image " + std::to_string(index + 1) + " is complete");
    }
    if (TIFFIsByteSwapped(tiff.get()) != 0) {
      const auto count = static_cast<tmsize_t>(row_samples);
      if (page.bits == 16) TIFFSwabArrayOfShort(reinterpret_cast<std::uint16_t*>(line.data()), count);
      if (page.bits == 32) TIFFSwabArrayOfLong(reinterpret_cast<std::uint32_t*>(line.data()), count);
      if (page.bits == 64) TIFFSwabArrayOfDouble(reinterpret_cast<double*>(line.data()), count);
    }
    plane.put(line.data(), page.width, spread, image, image.row(y));
  }
  if (page.photometric == PHOTOMETRIC_MINISWHITE) invert(samples, image);
}

}  // namespace fvd
