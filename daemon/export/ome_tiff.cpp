#include "daemon/export/ome_tiff.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

namespace {

constexpr std::uint64_t kStrip_bytes = std::uint64_t{1} << 20U;
constexpr double kMicrometresPerCentimetre = 1e4;

/// The file that libtiff writes to, and why it could not.
struct DiskFile {
  int fd = -1;
  int error = 0;       ///< errno of the first call that failed
  std::string reason;  ///< libtiff's words
};

DiskFile& disk_file(thandle_t handle) { return *static_cast<DiskFile*>(handle); }

tmsize_t failed(DiskFile& file) {
  if (file.error == 0) file.error = errno;
  return -1;
}

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t size) {
  DiskFile& file = disk_file(handle);
  for (;;) {
    const ssize_t count = ::read(file.fd, to, static_cast<std::size_t>(size));
    if (count >= 0) return count;
    if (errno != EINTR) return failed(file);
  }
}

tmsize_t write_bytes(thandle_t handle, void* from, tmsize_t size) {
  DiskFile& file = disk_file(handle);
  const char* bytes = static_cast<const char*>(from);
  for (tmsize_t done = 0; done < size;) {
    const ssize_t count = file_calls().write(file.fd, bytes + done, static_cast<std::size_t>(size - done));
    if (count >= 0) {
      done += count;
    } else if (errno != EINTR) {
      return failed(file);
    }
  }
  return size;
}

toff_t seek(thandle_t handle, toff_t offset, int from) {
  DiskFile& file = disk_file(handle);
  const off_t place = ::lseek(file.fd, static_cast<off_t>(offset), from);
  if (place < 0) failed(file);
  return static_cast<toff_t>(place);
}

int close_nothing(thandle_t /*handle*/) { return 0; }

toff_t file_size(thandle_t handle) {
  struct stat status {};
  return ::fstat(disk_file(handle).fd, &status) == 0 ? static_cast<toff_t>(status.st_size) : 0;
}

int keep_error(TIFF* /*tiff*/, void* file, const char* /*module*/, const char* format, std::va_list arguments) {
  char line[160];
  std::vsnprintf(line, sizeof line, format, arguments);
  static_cast<DiskFile*>(file)->reason = line;
  return 1;  // not to standard error as well
}

struct TiffCloser {
  void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, TiffCloser>;

Tiff open_to_write(DiskFile& file, const std::string& name, bool big) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &file);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep_error, &file);
  return Tiff(TIFFClientOpenExt(name.c_str(), big ? "w8m" : "wm", &file, read_bytes, write_bytes, seek, close_nothing,
                                file_size, nullptr, nullptr, options.get()));
}

std::uint32_t rows_per_strip(const OmeStack& stack) {
  const auto row = static_cast<std::uint64_t>(stack.width) * static_cast<std::uint64_t>(bytes_per_pixel(stack.format));
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(kStrip_bytes / row, 1, static_cast<std::uint64_t>(stack.height)));
}

/// No file of the stack is larger.
std::uint64_t most_bytes(const OmeStack& stack, const std::string& xml) {
  constexpr std::uint64_t kTags_bytes = 1024;
  constexpr std::uint64_t kStripPlace_bytes = 16;
  const auto rows = static_cast<std::uint64_t>(stack.height);
  const std::uint64_t plane =
      rows * static_cast<std::uint64_t>(stack.width) * static_cast<std::uint64_t>(bytes_per_pixel(stack.format));
  const std::uint64_t strips = rows / rows_per_strip(stack) + 1;
  return static_cast<std::uint64_t>(stack.slices()) * (plane + kTags_bytes + kStripPlace_bytes * strips) + xml.size();
}

void set_tags(TIFF* tiff, const OmeStack& stack) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(stack.width));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(stack.height));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * bytes_per_pixel(stack.format));
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows_per_strip(stack));
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, stack.software.c_str());
  if (stack.pitch_x_um && stack.pitch_y_um) {
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, kMicrometresPerCentimetre / *stack.pitch_x_um);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, kMicrometresPerCentimetre / *stack.pitch_y_um);
  }
}

/// Whether all of it was written. strip: memory that is used again.
bool write_page(TIFF* tiff, const ImageView& slice, std::uint32_t rows, std::vector<std::byte>& strip) {
  const auto row_bytes = static_cast<std::size_t>(slice.width * bytes_per_pixel(slice.format));
  std::uint32_t number = 0;
  for (int y = 0; y < slice.height; y += static_cast<int>(rows), ++number) {
    const int end = std::min(y + static_cast<int>(rows), slice.height);
    strip.clear();  // libtiff wants bytes that it may change
    for (int at = y; at < end; ++at) {
      const std::byte* const row = slice.data + at * slice.row_stride_bytes;
      strip.insert(strip.end(), row, row + row_bytes);
    }
    const auto size = static_cast<tmsize_t>(strip.size());
    if (TIFFWriteEncodedStrip(tiff, number, strip.data(), size) != size) return false;
  }
  return TIFFWriteDirectory(tiff) == 1;
}

}  // namespace

void write_ome_tiff(const std::filesystem::path& path, const OmeStack& stack, const SliceSource& source,
                    std::uint64_t classic_bytes) {
  assert(stack.slices() > 0 && stack.width > 0 && stack.height > 0);
  const std::string xml = ome_xml(stack);
  write_new_file_at_will(path, [&](int fd) {
    DiskFile file{fd, 0, {}};
    const auto check = [&](bool good) {
      if (good) return;
      if (file.error != 0) throw storage_error(file.error, "write", path);
      throw Error(ErrorCode::kInternal, "libtiff could not write " + path.string() + ": " + file.reason);
    };
    const Tiff tiff = open_to_write(file, path.string(), most_bytes(stack, xml) > classic_bytes);
    check(tiff != nullptr);
    std::vector<std::byte> strip;
    for (int index = 0; index < stack.slices(); ++index) {
      const ImageView slice = source(index);
      assert(slice.width == stack.width && slice.height == stack.height && slice.format == stack.format);
      set_tags(tiff.get(), stack);
      if (index == 0) TIFFSetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, xml.c_str());
      check(write_page(tiff.get(), slice, rows_per_strip(stack), strip));
    }
  });
}

}  // namespace fvd
