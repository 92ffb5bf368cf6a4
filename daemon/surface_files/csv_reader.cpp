/// Reads heights as rows of numbers.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "daemon/surface_files/file_bytes.hpp"
#include "daemon/surface_files/surface_readers.hpp"

namespace fvd {

namespace {

constexpr std::size_t kLongestLine = std::size_t{16} << 20U;
constexpr std::size_t kLongestNumber = 64;
constexpr std::size_t kMostHeaderLines = 1000;

/// A unit of heights, as a power of ten of the metre.
struct Unit {
  std::string_view name;
  std::string_view exponent;
};
constexpr std::array kUnits{Unit{"um", "e-6"}, Unit{"m", ""}, Unit{"mm", "e-3"}, Unit{"nm", "e-9"}};

struct Header {
  std::map<std::string, std::string, std::less<>> values;
  [[nodiscard]] std::optional<double> number(const FileBytes& file, std::string_view key) const {
    const auto found = values.find(key);
    if (found == values.end()) return std::nullopt;
    const auto value = number_of(found->second);
    if (!value) refuse(file.path(), "header, " + std::string(key), "it is no number");
    return value;
  }
};

void add_header_line(const FileBytes& file, std::size_t number, std::string_view text, Header& header) {
  text = trimmed(text.substr(1));
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return;  // a remark
  const std::string key(trimmed(text.substr(0, equals)));
  if (header.values.size() == kMostHeaderLines ||
      !header.values.try_emplace(key, trimmed(text.substr(equals + 1))).second) {
    refuse(file.path(), "line " + std::to_string(number),
           "'" + key + "' stands there twice, or the header is too long");
  }
}

char separator_of(std::string_view line) {
  for (const char separator : {';', ',', '\t'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

/// Calls use(cell) for every cell of the line; runs of blanks are one separator.
template <typename Use>
void for_each_cell(std::string_view line, char separator, const Use& use) {
  if (separator == ' ') line = trimmed(line);
  for (;;) {
    const auto end = line.find(separator);
    use(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
    if (separator == ' ') line = trimmed(line);
  }
}

/// Calls header(number, line) and row(number, line) for the lines that hold something.
template <typename OnHeader, typename OnRow>
void for_each_line(const FileBytes& file, const OnHeader& on_header, const OnRow& on_row) {
  ByteStream stream(file);
  std::size_t number = 0;
  while (const auto line = stream.line(kLongestLine)) {
    ++number;
    if (line->find('\0') != std::string::npos) {
      refuse(file.path(), "line " + std::to_string(number), "a NUL byte is no text");
    }
    const std::string_view text = trimmed(*line);
    if (text.empty()) continue;
    if (text.front() == '#') {
      on_header(number, text);
    } else {
      on_row(number, std::string_view(*line));
    }
  }
}

/// Decimal digits with the exponent of the unit: read as one number, so that nothing is rounded twice.
std::optional<float> height_m(std::string_view cell, const Unit& unit) {
  if (cell.empty()) return std::numeric_limits<float>::quiet_NaN();
  if (cell.size() > kLongestNumber) return std::nullopt;
  const bool has_exponent = cell.find_first_of("eEnN") != std::string_view::npos;
  std::string text(cell);
  if (has_exponent) {
    const auto value = number_of(text);
    if (!value) return std::nullopt;
    return height_of(*value * number_of("1" + std::string(unit.exponent)).value());
  }
  text += unit.exponent;
  const auto value = number_of(text);
  if (!value) return std::nullopt;
  float exact = 0.0F;
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), exact);
  return error == std::errc() ? exact : height_of(*value);
}

struct TextShape {
  std::int64_t width = 0;
  std::int64_t height = 0;
  char separator = ' ';
  Header header;
};

TextShape shape_of(const FileBytes& file) {
  TextShape shape;
  for_each_line(
      file, [&](std::size_t number, std::string_view text) { add_header_line(file, number, text, shape.header); },
      [&](std::size_t number, std::string_view text) {
        if (shape.height == 0) shape.separator = separator_of(text);
        std::int64_t cells = 0;
        for_each_cell(text, shape.separator, [&cells](std::string_view) { ++cells; });
        if (shape.height == 0) shape.width = cells;
        if (cells != shape.width) {
          refuse(file.path(), "line " + std::to_string(number),
                 std::to_string(cells) + " numbers, the first row has " + std::to_string(shape.width));
        }
        ++shape.height;
      });
  return shape;
}

Unit unit_of(const FileBytes& file, const Header& header) {
  const auto found = header.values.find("unit");
  if (found == header.values.end()) {
    refuse(file.path(), "header", "no line tells the unit of the heights, such as '# unit = um'");
  }
  for (const Unit& unit : kUnits) {
    if (unit.name == found->second) return unit;
  }
  refuse(file.path(), "header, unit", "'" + found->second + "' is none of m, mm, um and nm");
}

}  // namespace

Surface read_surface_csv(const std::filesystem::path& path, const SurfaceReadOptions& options) {
  const FileBytes file(path);
  const TextShape shape = shape_of(file);
  if (shape.height == 0) refuse(path, "file", "it has no row of numbers");
  const GridSize size = grid_size(path, "rows", shape.width, shape.height);
  const Unit unit = unit_of(file, shape.header);
  const double pitch_x_um =
      pitch_of(path, "header, pitch_x_um", shape.header.number(file, "pitch_x_um"), options.pitch_x_um);
  const double pitch_y_um =
      pitch_of(path, "header, pitch_y_um", shape.header.number(file, "pitch_y_um"), options.pitch_y_um);
  Surface surface = empty_surface(path, size, pitch_x_um, pitch_y_um);
  int y = 0;
  const auto put_row = [&](std::size_t number, std::string_view text) {
    int x = 0;
    for_each_cell(text, shape.separator, [&](std::string_view cell) {
      const auto height = height_m(cell, unit);
      if (x == size.width || y == size.height) {
        refuse(path, "line " + std::to_string(number), "the file changed while it was read");
      }
      if (!height) {
        refuse(path, "line " + std::to_string(number) + ", column " + std::to_string(x + 1),
               "'" + std::string(cell.substr(0, kLongestNumber)) + "' is no number");
      }
      surface.height_m.at(x++, y) = *height;
    });
    ++y;
  };
  for_each_line(
      file, [](std::size_t, std::string_view) {}, put_row);
  if (const auto title = shape.header.values.find("title"); title != shape.header.values.end()) {
    surface.title = title->second;
  }
  return surface;
}

}  // namespace fvd
