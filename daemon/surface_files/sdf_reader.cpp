/// Reads SDF (ISO 25178-71:2017), binary and ASCII.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <limits>

#include "daemon/surface_files/sdf_header.hpp"
#include "daemon/surface_files/surface_readers.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxTrailer_bytes = std::size_t{1} << 16U;
constexpr std::size_t kLongestNumber = 64;

template <typename T>
double as_number(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// The value of a point in the machine's byte order.
double stored_value(SdfType type, const char* bytes) {
  switch (type) {
    case SdfType::kUint8:
      return as_number<std::uint8_t>(bytes);
    case SdfType::kUint16:
      return as_number<std::uint16_t>(bytes);
    case SdfType::kUint32:
      return as_number<std::uint32_t>(bytes);
    case SdfType::kFloat:
      return as_number<float>(bytes);
    case SdfType::kInt8:
      return as_number<std::int8_t>(bytes);
    case SdfType::kInt16:
      return as_number<std::int16_t>(bytes);
    case SdfType::kInt32:
      return as_number<std::int32_t>(bytes);
    case SdfType::kDouble:
      break;
  }
  return as_number<double>(bytes);
}

float height_m(const SdfHeader& header, double value) {
  if (is_sdf_hole(header.type, value)) return std::numeric_limits<float>::quiet_NaN();
  return height_of(value * header.z_scale_m);
}

/// Behind the heights there may be text; anything else means that the header is not as long as it seems.
void check_trailer(const FileBytes& file, std::uint64_t offset) {
  if (file.size() - offset > kMaxTrailer_bytes) {
    refuse(file.path(), byte_place(offset), std::to_string(file.size() - offset) + " bytes stand behind the heights");
  }
  const std::string trailer = file.text(offset, kMaxTrailer_bytes);
  const bool is_text = std::all_of(trailer.begin(), trailer.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == 0 || std::isprint(byte) != 0 || std::isspace(byte) != 0;
  });
  if (!is_text) refuse(file.path(), byte_place(offset), "what stands behind the heights is no text");
}

Surface read_binary(const FileBytes& file, const SurfaceReadOptions& options) {
  const SdfHeader header = read_binary_sdf_header(file, options);
  const std::size_t bytes = sdf_type_bytes(header.type);
  const std::uint64_t end = kSdfHeaderBytes + header.size.points() * bytes;
  if (file.size() < end) {
    refuse(file.path(), byte_place(file.size()), "the file ends, its heights need " + std::to_string(end) + " bytes");
  }
  check_trailer(file, end);
  Surface surface = empty_surface(file.path(), header.size, header.pitch_x_um, header.pitch_y_um);
  std::string row(static_cast<std::size_t>(header.size.width) * bytes, '\0');
  for (int y = 0; y < header.size.height; ++y) {
    file.read(kSdfHeaderBytes + static_cast<std::uint64_t>(y) * row.size(), row.data(), row.size());
    for (int x = 0; x < header.size.width; ++x) {
      char* const point = row.data() + static_cast<std::size_t>(x) * bytes;
      if (header.big_endian) std::reverse(point, point + bytes);
      surface.height_m.at(x, y) = height_m(header, stored_value(header.type, point));
    }
  }
  return surface;
}

/// The next word; empty at the end. ";" begins a comment that ends with the line.
std::string next_word(const FileBytes& file, ByteStream& stream) {
  std::string word;
  bool comment = false;
  for (int byte = stream.peek(); byte != ByteStream::kEnd; byte = stream.peek()) {
    const bool blank = std::isspace(byte) != 0;
    if (blank && !word.empty()) return word;
    if (byte == ';') comment = true;
    if (byte == '\n') comment = false;
    if (!blank && !comment) {
      if (word.size() == kLongestNumber) refuse(file.path(), byte_place(stream.offset()), "a number is too long");
      word.push_back(static_cast<char>(byte));
    }
    stream.skip();
  }
  return word;
}

Surface read_ascii(const FileBytes& file, const SurfaceReadOptions& options) {
  ByteStream stream(file);
  if (!stream.line(kLongestNumber)) refuse(file.path(), byte_place(0), "the file is empty");
  const SdfHeader header = read_ascii_sdf_header(file, stream, options);
  if (header.size.points() > file.size() / 2 + 1) {  // a digit and a blank each
    refuse(file.path(), byte_place(stream.offset()), "the file is too short for its number of points");
  }
  Surface surface = empty_surface(file.path(), header.size, header.pitch_x_um, header.pitch_y_um);
  std::size_t point = 0;
  for (float& height : surface.height_m.pixels()) {
    const std::string word = next_word(file, stream);
    const std::string place = byte_place(stream.offset()) + ", point " + std::to_string(point++);
    if (word.empty() || word == "*") refuse(file.path(), place, "there are fewer heights than points");
    const auto value = word == "BAD" ? std::numeric_limits<double>::quiet_NaN() : number_of(word);
    if (!value) refuse(file.path(), place, "'" + word + "' is no number");
    height = height_m(header, *value);
  }
  if (const std::string word = next_word(file, stream); !word.empty() && word != "*") {
    refuse(file.path(), byte_place(stream.offset()), "there are more heights than points");
  }
  return surface;
}

}  // namespace

Surface read_sdf(const std::filesystem::path& path, const SurfaceReadOptions& options) {
  const FileBytes file(path);
  const std::string magic = file.text(0, kSdfMagicBytes);
  if (magic == "bISO-1.0" || magic == "bBCR-1.0") return read_binary(file, options);
  if (magic == "aISO-1.0" || magic == "aBCR-1.0") return read_ascii(file, options);
  refuse(path, byte_place(0), "it is none of the versions aISO-1.0, bISO-1.0, aBCR-1.0 and bBCR-1.0");
}

}  // namespace fvd
