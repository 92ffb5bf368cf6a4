/// Reads X3P (ISO 5436-2:2012, ISO 25178-72:2017).

#include <bit>
#include <cctype>
#include <cstring>
#include <limits>

#include "daemon/surface_files/surface_readers.hpp"
#include "daemon/surface_files/x3p_main.hpp"
#include "daemon/surface_files/zip_archive.hpp"

namespace fvd {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in the file");

constexpr const char* kMainEntry = "main.xml";
constexpr std::size_t kMaxMain_bytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxChecksum_bytes = 4096;

template <typename T>
void put_heights(std::string_view bytes, double increment_m, double offset_m, float* heights) {
  for (std::size_t i = 0; i < bytes.size() / sizeof(T); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof value);
    const double height_m = static_cast<double>(value) * increment_m;
    heights[i] = height_of(offset_m == 0.0 ? height_m : offset_m + height_m);  // -0.0 stays what it is
  }
}

void put(const X3pDescription& description, std::string_view bytes, float* heights) {
  const double increment_m = description.z_increment_m;
  const double offset_m = description.z_offset_m;
  switch (description.type) {
    case X3pDescription::Type::kInt16:
      return put_heights<std::int16_t>(bytes, increment_m, offset_m, heights);
    case X3pDescription::Type::kInt32:
      return put_heights<std::int32_t>(bytes, increment_m, offset_m, heights);
    case X3pDescription::Type::kFloat:
      return put_heights<float>(bytes, increment_m, offset_m, heights);
    case X3pDescription::Type::kDouble:
      return put_heights<double>(bytes, increment_m, offset_m, heights);
  }
}

void check_size(const FileBytes& file, const ZipArchive& archive, const std::string& entry, std::uint64_t needed) {
  const std::uint64_t size = archive.size(entry);
  if (size == needed) return;
  refuse(file.path(), "entry '" + entry + "'", std::to_string(size) + " bytes in place of " + std::to_string(needed));
}

void check_md5(const FileBytes& file, const std::string& entry, const std::string& computed, const std::string& told) {
  if (computed == told) return;
  refuse(file.path(), "entry '" + entry + "'", "its MD5 sum is " + computed + ", the file says " + told);
}

/// Returns main.xml, whose sum the archive tells in a file of its own.
std::string checked_main(const FileBytes& file, const ZipArchive& archive, std::string& md5) {
  if (const std::uint64_t size = archive.size(kMainEntry); size > kMaxMain_bytes) {
    refuse(file.path(), kMainEntry, std::to_string(size) + " bytes are above 1 MiB");
  }
  std::string xml;
  md5 = archive.read(kMainEntry, [&xml](std::string_view piece) { xml += piece; });
  return xml;
}

void check_main_md5(const FileBytes& file, const ZipArchive& archive, const std::string& checksum_file,
                    const std::string& computed) {
  const std::string text = archive.text(checksum_file, kMaxChecksum_bytes);
  std::string told(trimmed(text).substr(0, 32));
  for (char& digit : told) digit = static_cast<char>(std::tolower(static_cast<unsigned char>(digit)));
  check_md5(file, kMainEntry, computed, told);
}

void read_points(const FileBytes& file, const ZipArchive& archive, const X3pDescription& description,
                 Surface& surface) {
  check_size(file, archive, description.points_link, description.size.points() * description.point_bytes());
  float* next = surface.height_m.pixels().data();
  const std::string md5 = archive.read(description.points_link, [&](std::string_view piece) {
    put(description, piece, next);
    next += piece.size() / description.point_bytes();
  });
  check_md5(file, description.points_link, md5, description.points_md5);
}

/// One bit for a point, the lowest of a byte first; 1 = valid.
void read_valid(const FileBytes& file, const ZipArchive& archive, const X3pDescription& description, Surface& surface) {
  check_size(file, archive, description.valid_link, (description.size.points() + 7) / 8);
  const auto heights = surface.height_m.pixels();
  std::size_t point = 0;
  const std::string md5 = archive.read(description.valid_link, [&](std::string_view piece) {
    for (const char bits : piece) {
      for (unsigned bit = 0; bit < 8 && point < heights.size(); ++bit, ++point) {
        if ((static_cast<unsigned char>(bits) >> bit & 1U) == 0) {
          heights[point] = std::numeric_limits<float>::quiet_NaN();
        }
      }
    }
  });
  check_md5(file, description.valid_link, md5, description.valid_md5);
}

}  // namespace

Surface read_x3p(const std::filesystem::path& path, const SurfaceReadOptions& options) {
  const FileBytes file(path);
  const ZipArchive archive(file);
  std::string main_md5;
  const std::string xml = checked_main(file, archive, main_md5);
  const X3pDescription description = read_x3p_main(path, xml, options);
  check_main_md5(file, archive, description.checksum_file, main_md5);
  Surface surface = empty_surface(path, description.size, description.pitch_x_um, description.pitch_y_um);
  read_points(file, archive, description, surface);
  if (!description.valid_link.empty()) read_valid(file, archive, description, surface);
  return surface;
}

}  // namespace fvd
