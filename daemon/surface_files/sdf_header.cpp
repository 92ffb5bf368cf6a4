#include "daemon/surface_files/sdf_header.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "daemon/export/length_text.hpp"

namespace fvd {

namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr std::size_t kMostHeaderLines = 64;

/// What both forms hold, before it is looked at.
struct RawHeader {
  std::int64_t width = 0;
  std::int64_t height = 0;
  double pitch_x_um = 0.0;
  double pitch_y_um = 0.0;
  double z_scale_m = 0.0;
  std::int64_t compression = 0;
  std::int64_t type = 0;
  std::int64_t check = 0;
};

SdfHeader checked(const FileBytes& file, const RawHeader& raw, const SurfaceReadOptions& options) {
  const auto& path = file.path();
  SdfHeader header;
  header.size = grid_size(path, "header, NumPoints and NumProfiles", raw.width, raw.height);
  header.pitch_x_um = pitch_of(path, "header, Xscale", raw.pitch_x_um, options.pitch_x_um);
  header.pitch_y_um = pitch_of(path, "header, Yscale", raw.pitch_y_um, options.pitch_y_um);
  if (!std::isfinite(raw.z_scale_m) || raw.z_scale_m <= 0.0) refuse(path, "header, Zscale", "it is not above 0");
  header.z_scale_m = raw.z_scale_m;
  if (raw.compression != 0) refuse(path, "header, Compression", "compressed heights are not read");
  if (raw.check != 0) refuse(path, "header, CheckType", "a check of type " + std::to_string(raw.check) + " is unknown");
  if (raw.type < 0 || raw.type > static_cast<int>(SdfType::kDouble)) {
    refuse(path, "header, DataType", std::to_string(raw.type) + " is not 0 to 7");
  }
  header.type = static_cast<SdfType>(raw.type);
  return header;
}

/// A little-endian or big-endian value of the binary header.
template <typename T>
T value_at(std::array<char, kSdfHeaderBytes>& bytes, std::size_t offset, bool big_endian) {
  std::array<char, sizeof(T)> raw;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), raw.begin());
  if (big_endian) std::reverse(raw.begin(), raw.end());
  T value;
  std::memcpy(&value, raw.data(), sizeof value);
  return value;
}

RawHeader raw_header(std::array<char, kSdfHeaderBytes>& bytes, bool big_endian) {
  RawHeader raw;
  raw.width = value_at<std::uint16_t>(bytes, 42, big_endian);
  raw.height = value_at<std::uint16_t>(bytes, 44, big_endian);
  raw.pitch_x_um = micrometres_of(value_at<double>(bytes, 46, big_endian));
  raw.pitch_y_um = micrometres_of(value_at<double>(bytes, 54, big_endian));
  raw.z_scale_m = value_at<double>(bytes, 62, big_endian);
  raw.compression = value_at<std::uint8_t>(bytes, 78, big_endian);
  raw.type = value_at<std::uint8_t>(bytes, 79, big_endian);
  raw.check = value_at<std::uint8_t>(bytes, 80, big_endian);
  return raw;
}

/// How long the file would be; nothing where the type is none.
std::optional<std::uint64_t> file_size_of(const RawHeader& raw) {
  if (raw.type > static_cast<int>(SdfType::kDouble)) return std::nullopt;
  return kSdfHeaderBytes + static_cast<std::uint64_t>(raw.width) * static_cast<std::uint64_t>(raw.height) *
                               sdf_type_bytes(static_cast<SdfType>(raw.type));
}

double least_of(SdfType type) {
  switch (type) {
    case SdfType::kInt8:
      return std::numeric_limits<std::int8_t>::min();
    case SdfType::kInt16:
      return std::numeric_limits<std::int16_t>::min();
    case SdfType::kInt32:
      return std::numeric_limits<std::int32_t>::min();
    case SdfType::kFloat:
      return static_cast<double>(std::numeric_limits<float>::lowest());
    case SdfType::kDouble:
      return std::numeric_limits<double>::lowest();
    default:
      return -1.0;  // unsigned types have no such value
  }
}

/// "key = value" until the line with "*"; ";" begins a comment.
std::map<std::string, std::string> ascii_values(const FileBytes& file, ByteStream& stream) {
  std::map<std::string, std::string> values;
  for (std::size_t i = 0; i < kMostHeaderLines; ++i) {
    const std::uint64_t place = stream.offset();
    const auto line = stream.line(kLongestLine);
    if (!line) refuse(file.path(), byte_place(place), "the file ends within the header");
    const std::string_view text = trimmed(std::string_view(*line).substr(0, line->find(';')));
    if (text.empty()) continue;
    if (text == "*") return values;
    const auto equals = text.find('=');
    if (equals == std::string_view::npos) refuse(file.path(), byte_place(place), "a header line has no '='");
    const std::string key(trimmed(text.substr(0, equals)));
    if (!values.try_emplace(key, trimmed(text.substr(equals + 1))).second) {
      refuse(file.path(), byte_place(place), "'" + key + "' stands there twice");
    }
  }
  refuse(file.path(), byte_place(stream.offset()), "the header has too many lines");
}

}  // namespace

std::size_t sdf_type_bytes(SdfType type) noexcept {
  constexpr std::array<std::size_t, 8> kBytes{1, 2, 4, 4, 1, 2, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

bool is_sdf_hole(SdfType type, double value) noexcept {
  return !std::isfinite(value) || (least_of(type) < -1.0 && value == least_of(type));
}

SdfHeader read_binary_sdf_header(const FileBytes& file, const SurfaceReadOptions& options) {
  std::array<char, kSdfHeaderBytes> bytes;
  file.read(0, bytes.data(), bytes.size());
  RawHeader raw = raw_header(bytes, false);
  const RawHeader swapped = raw_header(bytes, true);
  const auto fits = file_size_of(raw);
  const bool big_endian = fits && *fits != file.size() && file_size_of(swapped) == file.size();
  if (big_endian) raw = swapped;
  SdfHeader header = checked(file, raw, options);
  header.big_endian = big_endian;
  return header;
}

SdfHeader read_ascii_sdf_header(const FileBytes& file, ByteStream& stream, const SurfaceReadOptions& options) {
  const auto values = ascii_values(file, stream);
  const auto text_of = [&](const char* key) -> std::string_view {
    const auto found = values.find(key);
    if (found == values.end()) refuse(file.path(), std::string("header, ") + key, "it is missing");
    return found->second;
  };
  const auto integer = [&](const char* key) {
    const auto value = integer_of(text_of(key));
    if (!value) refuse(file.path(), std::string("header, ") + key, "it is no integer");
    return *value;
  };
  const auto length_um = [&](const char* key) {
    const auto value = micrometres_of_text(text_of(key));
    if (!value) refuse(file.path(), std::string("header, ") + key, "it is no number");
    return *value;
  };
  RawHeader raw;
  raw.width = integer("NumPoints");
  raw.height = integer("NumProfiles");
  raw.pitch_x_um = length_um("Xscale");
  raw.pitch_y_um = length_um("Yscale");
  const auto z_scale = number_of(text_of("Zscale"));
  if (!z_scale) refuse(file.path(), "header, Zscale", "it is no number");
  raw.z_scale_m = *z_scale;
  raw.compression = values.contains("Compression") ? integer("Compression") : 0;
  raw.type = integer("DataType");
  raw.check = values.contains("CheckType") ? integer("CheckType") : 0;
  return checked(file, raw, options);
}

}  // namespace fvd
