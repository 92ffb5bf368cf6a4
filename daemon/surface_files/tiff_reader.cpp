/// Reads a TIFF of floats (TIFF 6.0).

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/surface_readers.hpp"
#include "drivers/replay/tiff_handle.hpp"

namespace fvd {

namespace {

constexpr std::uint64_t kMaxRatio = 200;
constexpr std::uint64_t kMaxStrip_bytes = std::uint64_t{16} << 20U;

/// One row of floats of either width into heights.
void put_row(const char* bytes, bool wide, float* heights, int width) {
  for (int x = 0; x < width; ++x) {
    double value = 0.0;
    if (wide) {
      std::memcpy(&value, bytes + static_cast<std::size_t>(x) * sizeof(double), sizeof value);
    } else {
      float narrow = 0.0F;
      std::memcpy(&narrow, bytes + static_cast<std::size_t>(x) * sizeof(float), sizeof narrow);
      value = static_cast<double>(narrow);
    }
    heights[x] = height_of(value);
  }
}

void check_layout(const FileBytes& file, TIFF* tiff, const TiffPage& page) {
  const auto& path = file.path();
  if (TIFFNumberOfDirectories(tiff) != 1) refuse(path, "page 1", "the file has several pages");
  if (page.samples != 1) refuse(path, "page 1, SamplesPerPixel", "it is not 1");
  if (page.sample_format != SAMPLEFORMAT_IEEEFP || (page.bits != 32 && page.bits != 64)) {
    refuse(path, "page 1, SampleFormat", "the samples are no floats of 32 or 64 bit");
  }
  constexpr std::array kCompressions{COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_DEFLATE, COMPRESSION_ADOBE_DEFLATE,
                                     COMPRESSION_PACKBITS};
  if (std::find(kCompressions.begin(), kCompressions.end(), page.compression) == kCompressions.end()) {
    refuse(path, "page 1, Compression", std::to_string(page.compression) + " is not read");
  }
  if (TIFFIsTiled(tiff) != 0) refuse(path, "page 1", "tiles are not read");
}

/// Uncompressed strips are read by their places: libtiff would take a strip, which may be all of the file, at once.
void read_plain(const FileBytes& file, TIFF* tiff, const TiffPage& page, Surface& surface) {
  std::uint64_t* offsets = nullptr;
  std::uint32_t rows_per_strip = page.height;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &rows_per_strip);
  if (TIFFGetField(tiff, TIFFTAG_STRIPOFFSETS, &offsets) != 1 || offsets == nullptr || rows_per_strip == 0) {
    refuse(file.path(), "page 1, StripOffsets", "it is missing");
  }
  const std::uint32_t strips = TIFFNumberOfStrips(tiff);
  const bool wide = page.bits == 64;
  const std::size_t bytes = wide ? sizeof(double) : sizeof(float);
  std::string row(page.width * bytes, '\0');
  for (std::uint32_t y = 0; y < page.height; ++y) {
    const std::uint32_t strip = y / rows_per_strip;
    if (strip >= strips) refuse(file.path(), "page 1, StripOffsets", "there are too few strips");
    file.read(offsets[strip] + static_cast<std::uint64_t>(y % rows_per_strip) * row.size(), row.data(), row.size());
    if (TIFFIsByteSwapped(tiff) != 0) {
      for (std::size_t at = 0; at < row.size(); at += bytes) std::reverse(row.data() + at, row.data() + at + bytes);
    }
    put_row(row.data(), wide, surface.height_m.row(static_cast<int>(y)), surface.width());
  }
}

void read_compressed(const FileBytes& file, TIFF* tiff, const TiffPage& page, const std::string& error,
                     Surface& surface) {
  if (TIFFStripSize64(tiff) > kMaxStrip_bytes) refuse(file.path(), "page 1", "a compressed strip is above 16 MiB");
  std::vector<char> row(static_cast<std::size_t>(TIFFScanlineSize64(tiff)));
  if (row.size() < page.width * (page.bits / 8U)) refuse(file.path(), "page 1", "its rows are too short");
  for (int y = 0; y < surface.height(); ++y) {
    if (TIFFReadScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0) != 1) {
      refuse(file.path(), "row " + std::to_string(y), error.empty() ? "it cannot be read" : error);
    }
    put_row(row.data(), page.bits == 64, surface.height_m.row(y), surface.width());
  }
}

}  // namespace

Surface read_float_tiff(const std::filesystem::path& path, const SurfaceReadOptions& options) {
  const FileBytes file(path);
  std::string error;
  const Tiff tiff = open_tiff(path, error);
  if (!tiff) refuse(path, byte_place(0), error.empty() ? "it is no TIFF" : error);
  const TiffPage page = page_of(tiff.get());
  check_layout(file, tiff.get(), page);
  const GridSize size = grid_size(path, "page 1, ImageWidth and ImageLength", page.width, page.height);
  const double pitch_x_um = pitch_of(path, "page 1", std::nullopt, options.pitch_x_um);
  const double pitch_y_um = pitch_of(path, "page 1", std::nullopt, options.pitch_y_um);
  const std::uint64_t bytes = size.points() * (page.bits / 8U);
  const bool plain = page.compression == COMPRESSION_NONE;
  if (plain && bytes > file.size()) refuse(path, "page 1", "the file is too short for its number of points");
  if (bytes / kMaxRatio > file.size()) refuse(path, "page 1", "it is compressed by more than 200");
  Surface surface = empty_surface(path, size, pitch_x_um, pitch_y_um);
  if (plain) {
    read_plain(file, tiff.get(), page, surface);
  } else {
    read_compressed(file, tiff.get(), page, error, surface);
  }
  return surface;
}

}  // namespace fvd
