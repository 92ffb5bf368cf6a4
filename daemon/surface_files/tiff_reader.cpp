/// Reads a TIFF of floats (TIFF 6.0).

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/map_rows.hpp"
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

/// Where the rows of an uncompressed page stand: libtiff would take a strip, which may be all of the file, at once.
class PlainRows {
 public:
  PlainRows(const FileBytes& file, TIFF* tiff, const TiffPage& page)
      : width_(page.width), bytes_(page.bits / 8U), swapped_(TIFFIsByteSwapped(tiff) != 0) {
    std::uint64_t* offsets = nullptr;
    rows_per_strip_ = page.height;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &rows_per_strip_);
    if (TIFFGetField(tiff, TIFFTAG_STRIPOFFSETS, &offsets) != 1 || offsets == nullptr || rows_per_strip_ == 0) {
      refuse(file.path(), "page 1, StripOffsets", "it is missing");
    }
    strips_.assign(offsets, offsets + TIFFNumberOfStrips(tiff));
    if ((page.height - 1) / rows_per_strip_ >= strips_.size()) {
      refuse(file.path(), "page 1, StripOffsets", "there are too few strips");
    }
  }

  void read(const FileBytes& file, int x, int y, int count, float* to) const {
    const auto row = static_cast<std::uint64_t>(y);
    const std::uint64_t place = strips_[row / rows_per_strip_] + row % rows_per_strip_ * width_ * bytes_;
    std::string samples(static_cast<std::size_t>(count) * bytes_, '\0');
    file.read(place + static_cast<std::uint64_t>(x) * bytes_, samples.data(), samples.size());
    if (swapped_) {
      for (std::size_t at = 0; at < samples.size(); at += bytes_) {
        std::reverse(samples.data() + at, samples.data() + at + bytes_);
      }
    }
    put_row(samples.data(), bytes_ == sizeof(double), to, count);
  }

 private:
  std::uint32_t width_;
  std::size_t bytes_;  // of a sample
  bool swapped_;
  std::uint32_t rows_per_strip_ = 0;
  std::vector<std::uint64_t> strips_;
};

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

/// A file that was looked at: its sizes fit.
struct FloatTiff {
  explicit FloatTiff(const std::filesystem::path& path) : file(path), tiff(open_tiff(path, error)) {
    if (!tiff) refuse(path, byte_place(0), error.empty() ? "it is no TIFF" : error);
    page = page_of(tiff.get());
    check_layout(file, tiff.get(), page);
    size = grid_size(path, "page 1, ImageWidth and ImageLength", page.width, page.height);
    const std::uint64_t bytes = size.points() * (page.bits / 8U);
    if (is_plain() && bytes > file.size()) refuse(path, "page 1", "the file is too short for its number of points");
    if (bytes / kMaxRatio > file.size()) refuse(path, "page 1", "it is compressed by more than 200");
  }
  [[nodiscard]] bool is_plain() const { return page.compression == COMPRESSION_NONE; }

  FileBytes file;
  std::string error;  // before the handle, whose errors go there
  Tiff tiff;
  TiffPage page;
  GridSize size;
};

class TiffRows final : public MapRows {
 public:
  TiffRows(FileBytes&& file, const GridSize& size, PlainRows&& rows)
      : file_(std::move(file)), size_(size), rows_(std::move(rows)) {}
  [[nodiscard]] GridSize size() const noexcept override { return size_; }
  void read(int x, int y, int count, float* to) const override { rows_.read(file_, x, y, count, to); }

 private:
  const FileBytes file_;
  const GridSize size_;
  const PlainRows rows_;
};

}  // namespace

Surface read_float_tiff(const std::filesystem::path& path, const SurfaceReadOptions& options) {
  const FloatTiff tiff(path);
  const double pitch_x_um = pitch_of(path, "page 1", std::nullopt, options.pitch_x_um);
  const double pitch_y_um = pitch_of(path, "page 1", std::nullopt, options.pitch_y_um);
  Surface surface = empty_surface(path, tiff.size, pitch_x_um, pitch_y_um);
  if (!tiff.is_plain()) {
    read_compressed(tiff.file, tiff.tiff.get(), tiff.page, tiff.error, surface);
    return surface;
  }
  const PlainRows rows(tiff.file, tiff.tiff.get(), tiff.page);
  for (int y = 0; y < surface.height(); ++y) rows.read(tiff.file, 0, y, surface.width(), surface.height_m.row(y));
  return surface;
}

std::shared_ptr<const MapRows> open_tiff_rows(const std::filesystem::path& path) {
  FloatTiff tiff(path);
  if (!tiff.is_plain()) return nullptr;
  PlainRows rows(tiff.file, tiff.tiff.get(), tiff.page);
  return std::make_shared<TiffRows>(std::move(tiff.file), tiff.size, std::move(rows));
}

}  // namespace fvd
