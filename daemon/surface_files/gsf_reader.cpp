/// Reads Gwyddion Simple Field 1.0 (http://gwyddion.net/documentation/user-guide-en/gsf.html).

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <span>

#include "daemon/export/length_text.hpp"
#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/map_rows.hpp"
#include "daemon/surface_files/surface_readers.hpp"

namespace fvd {

namespace {

constexpr std::string_view kMagic = "Gwyddion Simple Field 1.0\n";
constexpr std::size_t kMaxHeader_bytes = std::size_t{1} << 20U;

/// The lines of the header, and where the heights begin.
struct Header {
  std::map<std::string, std::string, std::less<>> values;
  std::uint64_t data_offset = 0;

  [[nodiscard]] std::string_view value(std::string_view key) const {
    const auto found = values.find(key);
    return found == values.end() ? std::string_view{} : std::string_view(found->second);
  }
};

Header header_of(const FileBytes& file) {
  const std::string head = file.text(0, kMaxHeader_bytes);
  if (!head.starts_with(kMagic)) refuse(file.path(), byte_place(0), "it does not begin as a Gwyddion Simple Field");
  const auto end = head.find('\0');
  if (end == std::string::npos) {
    refuse(file.path(), byte_place(head.size()), "no NUL byte ends the header");
  }
  Header header;
  for (std::size_t at = kMagic.size(); at < end;) {
    const std::size_t stop = std::min(head.find('\n', at), end);
    const std::string_view line(head.data() + at, stop - at);
    const auto equals = line.find('=');
    if (equals == std::string_view::npos) refuse(file.path(), byte_place(at), "a header line has no '='");
    const std::string key(trimmed(line.substr(0, equals)));
    if (!header.values.try_emplace(key, trimmed(line.substr(equals + 1))).second) {
      refuse(file.path(), byte_place(at), "'" + key + "' stands there twice");
    }
    at = stop + 1;
  }
  header.data_offset = end + 4 - end % 4;
  for (std::size_t at = end; at < header.data_offset; ++at) {
    if (at >= head.size() || head[at] != '\0')
      refuse(file.path(), byte_place(at), "the header is not filled up by NULs");
  }
  return header;
}

GridSize size_of(const FileBytes& file, const Header& header) {
  const auto width = integer_of(header.value("XRes"));
  const auto height = integer_of(header.value("YRes"));
  if (!width || !height) refuse(file.path(), "header", "XRes or YRes is missing or no integer");
  return grid_size(file.path(), "header, XRes and YRes", *width, *height);
}

/// Of one axis; nothing where the unit is pixels.
std::optional<double> told_pitch_um(const FileBytes& file, const Header& header, const char* key, int count) {
  const std::string_view unit = header.value("XYUnits");
  if (unit == "px" || unit.empty()) return std::nullopt;
  if (unit != "m") refuse(file.path(), "header, XYUnits", "'" + std::string(unit) + "' is not m");
  if (header.value(key).empty()) return micrometres_of_text("1", count);  // the format's default
  const auto pitch_um = micrometres_of_text(header.value(key), count);
  if (!pitch_um) refuse(file.path(), std::string("header, ") + key, "it is no number");
  return pitch_um;
}

/// Sizes that fit the file.
GridSize checked_size(const FileBytes& file, const Header& header) {
  const GridSize size = size_of(file, header);
  if (header.value("ZUnits") != "m") refuse(file.path(), "header, ZUnits", "the heights are not in m");
  const std::uint64_t needed = header.data_offset + size.points() * sizeof(float);
  if (file.size() != needed) {
    refuse(file.path(), byte_place(header.data_offset),
           "the file has " + std::to_string(file.size()) + " bytes in place of " + std::to_string(needed));
  }
  return size;
}

void clear_infinities(std::span<float> heights) {
  for (float& height : heights) {
    if (!std::isfinite(height)) height = std::numeric_limits<float>::quiet_NaN();
  }
}

class GsfRows final : public MapRows {
 public:
  explicit GsfRows(const std::filesystem::path& path) : file_(path) {
    const Header header = header_of(file_);
    size_ = checked_size(file_, header);
    data_offset_ = header.data_offset;
  }
  [[nodiscard]] GridSize size() const noexcept override { return size_; }
  void read(int x, int y, int count, float* to) const override {
    const auto point =
        static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(size_.width) + static_cast<std::uint64_t>(x);
    const std::span<float> heights(to, static_cast<std::size_t>(count));
    file_.read(data_offset_ + point * sizeof(float), heights.data(), heights.size_bytes());
    clear_infinities(heights);
  }

 private:
  FileBytes file_;
  GridSize size_;
  std::uint64_t data_offset_ = 0;
};

}  // namespace

Surface read_gsf(const std::filesystem::path& path, const SurfaceReadOptions& options) {
  const FileBytes file(path);
  const Header header = header_of(file);
  const GridSize size = checked_size(file, header);
  const double pitch_x_um =
      pitch_of(path, "header, XReal", told_pitch_um(file, header, "XReal", size.width), options.pitch_x_um);
  const double pitch_y_um =
      pitch_of(path, "header, YReal", told_pitch_um(file, header, "YReal", size.height), options.pitch_y_um);
  Surface surface = empty_surface(path, size, pitch_x_um, pitch_y_um);
  const auto heights = surface.height_m.pixels();
  file.read(header.data_offset, heights.data(), heights.size_bytes());
  clear_infinities(heights);
  if (!header.value("Title").empty()) surface.title = header.value("Title");
  return surface;
}

std::shared_ptr<const MapRows> open_gsf_rows(const std::filesystem::path& path) {
  return std::make_shared<GsfRows>(path);
}

}  // namespace fvd
