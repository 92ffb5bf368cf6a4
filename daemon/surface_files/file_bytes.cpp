#include "daemon/surface_files/file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::size_t kChunk_bytes = std::size_t{1} << 18U;
constexpr std::int64_t kMaxSide = 1'000'000;
constexpr std::int64_t kMaxPoints = std::int64_t{1} << 29U;
constexpr double kMinPitch_um = 1e-6;
constexpr double kMaxPitch_um = 1e6;
constexpr double kSamePitch = 1e-6;  // relative

template <typename Number>
std::optional<Number> whole(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_pitch(double um) { return um >= kMinPitch_um && um <= kMaxPitch_um; }

}  // namespace

void refuse(const std::filesystem::path& path, const std::string& place, const std::string& reason) {
  throw Error(ErrorCode::kSurfaceFile, path.string() + ": " + place + ": " + reason);
}

std::string byte_place(std::uint64_t offset) { return "byte " + std::to_string(offset); }

FileBytes::FileBytes(const std::filesystem::path& path)
    : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (!file_.valid()) refuse(path, "file", std::strerror(errno));
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) refuse(path, "file", std::strerror(errno));
  if (!S_ISREG(status.st_mode)) refuse(path, "file", "it is no regular file");
  size_ = static_cast<std::uint64_t>(status.st_size);
}

void FileBytes::read(std::uint64_t offset, void* to, std::size_t bytes) const {
  auto* place = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t got = ::pread(file_.get(), place, bytes, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(path_, byte_place(offset), std::strerror(errno));
    if (got == 0) refuse(path_, byte_place(offset), "the file ends, " + std::to_string(bytes) + " bytes are missing");
    place += got;
    offset += static_cast<std::uint64_t>(got);
    bytes -= static_cast<std::size_t>(got);
  }
}

std::string FileBytes::text(std::uint64_t offset, std::size_t most) const {
  if (offset >= size_) return {};
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(most, size_ - offset)), '\0');
  read(offset, bytes.data(), bytes.size());
  return bytes;
}

void ByteStream::fill() {
  buffer_ = file_.text(next_, kChunk_bytes);
  next_ += buffer_.size();
  used_ = 0;
}

std::optional<std::string> ByteStream::line(std::size_t longest) {
  if (peek() == kEnd) return std::nullopt;
  std::string text;
  for (int byte = peek(); byte != kEnd; byte = peek()) {
    skip();
    if (byte == '\n') break;
    if (text.size() == longest) {
      refuse(file_.path(), byte_place(offset()), "a line is longer than " + std::to_string(longest) + " bytes");
    }
    text.push_back(static_cast<char>(byte));
  }
  if (text.ends_with('\r')) text.pop_back();
  return text;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks(" \t\r\n\0", 5);
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::optional<double> number_of(std::string_view text) { return whole<double>(text); }
std::optional<std::int64_t> integer_of(std::string_view text) { return whole<std::int64_t>(text); }

float height_of(double metres) noexcept {
  constexpr auto kLargest = static_cast<double>(std::numeric_limits<float>::max());
  if (!(std::abs(metres) <= kLargest)) return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(metres);
}

GridSize grid_size(const std::filesystem::path& path, const std::string& place, std::int64_t width,
                   std::int64_t height) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " points";
  if (width < 1 || height < 1) refuse(path, place, size + ": a side is below 1");
  if (width > kMaxSide || height > kMaxSide) {
    refuse(path, place, size + ": a side is above " + std::to_string(kMaxSide));
  }
  if (width * height > kMaxPoints) refuse(path, place, size + " are more than " + std::to_string(kMaxPoints));
  return {static_cast<int>(width), static_cast<int>(height)};
}

double pitch_of(const std::filesystem::path& path, const std::string& place, const std::optional<double>& told_um,
                const std::optional<double>& given_um) {
  if (!told_um && !given_um) {
    refuse(path, place, "the file does not tell the distance of its points: it must be given");
  }
  const auto text = [](double um) { return std::to_string(um) + " um"; };
  for (const std::optional<double>& pitch_um : {told_um, given_um}) {
    if (pitch_um && !is_pitch(*pitch_um)) {
      refuse(path, place, "a pitch of " + text(*pitch_um) + " is not within 1e-6 to 1e6 um");
    }
  }
  if (told_um && given_um && std::abs(*told_um - *given_um) > kSamePitch * *told_um) {
    refuse(path, place, "the file tells a pitch of " + text(*told_um) + ", given is " + text(*given_um));
  }
  return told_um ? *told_um : *given_um;
}

Surface empty_surface(const std::filesystem::path& path, const GridSize& size, double pitch_x_um, double pitch_y_um) {
  Surface surface;
  surface.height_m = Plane<float>::unset(size.width, size.height);
  surface.pitch_x_um = pitch_x_um;
  surface.pitch_y_um = pitch_y_um;
  surface.title = path.stem().string();
  return surface;
}

}  // namespace fvd
