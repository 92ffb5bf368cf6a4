#include "daemon/export/height_tiff.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include <tiffio.h>

#include "core/base/error.hpp"
#include "daemon/export/export_input.hpp"

namespace fvd {

namespace {

/// A file in memory that libtiff writes to.
struct MemoryFile {
  std::string bytes;
  std::size_t position = 0;
};

MemoryFile& memory_file(thandle_t handle) { return *static_cast<MemoryFile*>(handle); }

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t size) {
  MemoryFile& file = memory_file(handle);
  const std::size_t there = file.bytes.size() - std::min(file.position, file.bytes.size());
  const std::size_t count = std::min(static_cast<std::size_t>(size), there);
  std::memcpy(to, file.bytes.data() + file.position, count);
  file.position += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t write_bytes(thandle_t handle, void* from, tmsize_t size) {
  MemoryFile& file = memory_file(handle);
  const auto count = static_cast<std::size_t>(size);
  if (file.position + count > file.bytes.size()) file.bytes.resize(file.position + count);
  std::memcpy(file.bytes.data() + file.position, from, count);
  file.position += count;
  return size;
}

toff_t seek(thandle_t handle, toff_t offset, int from) {
  MemoryFile& file = memory_file(handle);
  const toff_t base = from == SEEK_CUR ? file.position : from == SEEK_END ? file.bytes.size() : 0;
  file.position = static_cast<std::size_t>(base + offset);
  return file.position;
}

int close_nothing(thandle_t /*handle*/) { return 0; }
toff_t file_size(thandle_t handle) { return memory_file(handle).bytes.size(); }

struct TiffCloser {
  void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
};

constexpr double kMicrometresPerCentimetre = 1e4;
constexpr std::size_t kHeaderRoom = std::size_t{64} << 10;  // tags and the places of the strips

void set_tags(TIFF* tiff, const Plane<float>& height_m, const TiffTags& tags) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(height_m.width()));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(height_m.height()));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, tags.software.c_str());
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, tags.description.c_str());
  if (tags.pitch_x_um && tags.pitch_y_um) {
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, kMicrometresPerCentimetre / *tags.pitch_x_um);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, kMicrometresPerCentimetre / *tags.pitch_y_um);
  }
}

TiffTags tiff_tags(const ExportInput& input, const std::string& quantity) {
  const ResultData& data = input.data;
  return {data.software_version,
          result_title(data) + ": " + quantity + " in metres, NaN where invalid, peak " +
              std::string(peak_method_name(input.peak)) + (data.simulated ? ", SIMULATED" : ""),
          data.pixel_pitch_x_um, data.pixel_pitch_y_um};
}

}  // namespace

std::string encode_height_tiff(const Plane<float>& height_m, const TiffTags& tags) {
  MemoryFile file;
  file.bytes.reserve(height_m.pixels().size_bytes() + kHeaderRoom);
  const std::unique_ptr<TIFF, TiffCloser> tiff(TIFFClientOpen("height map", "wm", &file, read_bytes, write_bytes, seek,
                                                              close_nothing, file_size, nullptr, nullptr));
  if (!tiff) throw Error(ErrorCode::kInternal, "libtiff cannot write to memory");
  set_tags(tiff.get(), height_m, tags);
  // Strip by strip and not row by row: libtiff hands uncompressed strips on as they are, and does not change them.
  std::uint32_t rows_a_strip = 0;
  TIFFGetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, &rows_a_strip);
  const int step = static_cast<int>(rows_a_strip);
  for (int y = 0; y < height_m.height(); y += step) {
    const int rows = std::min(step, height_m.height() - y);
    const auto bytes = static_cast<tmsize_t>(sizeof(float)) * rows * height_m.width();
    auto* const strip = const_cast<float*>(height_m.row(y));
    if (TIFFWriteEncodedStrip(tiff.get(), static_cast<std::uint32_t>(y / step), strip, bytes) != bytes) {
      throw Error(ErrorCode::kInternal, "libtiff refused row " + std::to_string(y) + " of the height map");
    }
  }
  if (TIFFFlush(tiff.get()) != 1) throw Error(ErrorCode::kInternal, "libtiff could not finish the height map");
  return std::move(file.bytes);
}

std::string height_tiff_file(const ExportInput& input) {
  return encode_height_tiff(input.map.height_m, tiff_tags(input, "height"));
}

std::string smooth_height_tiff_file(const ExportInput& input) {
  return encode_height_tiff(input.data.smoothed.value().height_m, tiff_tags(input, "smoothed height"));
}

std::string smooth_sigma_tiff_file(const ExportInput& input) {
  return encode_height_tiff(input.data.smoothed.value().sigma_m,
                            tiff_tags(input, "standard error of smoothed heights"));
}

std::string repeat_sd_tiff_file(const ExportInput& input) {
  return encode_height_tiff(
      input.data.repeated.value().sd_m,
      tiff_tags(input, "standard deviation of " + std::to_string(input.data.repeated->scans) + " scans"));
}

std::string sigma_tiff_file(const ExportInput& input) {
  return encode_height_tiff(input.map.sigma_m, tiff_tags(input, "standard error"));
}

}  // namespace fvd
