#include "drivers/replay/z_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "drivers/replay/name_fields.hpp"
#include "drivers/replay/text_encoding.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

struct Line {
  int number = 0;
  std::string text;
};

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kBadInput, message); }

[[noreturn]] void refuse(const fs::path& file, const Line& line, const std::string& why) {
  refuse(file.string() + " line " + std::to_string(line.number) + ": '" + printable(line.text) + "' " + why);
}

std::string read_text(const fs::path& file) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 24U;  // a list of a million slices
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse("cannot read the z file " + file.string());
  std::string bytes;
  for (std::istreambuf_iterator<char> at(stream), end; at != end && bytes.size() <= kMaxBytes; ++at) bytes += *at;
  if (stream.bad() || fs::is_directory(file)) refuse("reading the z file " + file.string() + " failed");
  if (bytes.size() > kMaxBytes) refuse("the z file " + file.string() + " is above 16 MiB: it is no list of heights");
  try {
    return to_utf8(bytes);
  } catch (const Error& error) {
    refuse("the z file " + file.string() + " " + error.what());
  }
}

/// Without comments, blanks at the ends, and empty lines. Lines end with CR, LF or both.
std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> lines;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    std::string line = text.substr(at, end - at);
    at = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++number;
    line.resize(std::min(line.find('#'), line.size()));
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    lines.push_back({number, line.substr(first, line.find_last_not_of(" \t") - first + 1)});
  }
  return lines;
}

/// A first line of words. Returns the unit that it names: "z / mm", "z_um"; empty: none.
bool is_header(const std::string& text) {
  static const std::regex kNumber("[-+]?(?:[0-9.].*|nan|inf(?:inity)?)", std::regex::icase);
  return text.find_first_of("\"'(") == 0 || !std::regex_match(text, kNumber);
}

std::string unit_in(const std::string& header) {
  static const std::regex kUnit("(?:^|[^a-z])(um|\xC2\xB5m|\xCE\xBCm|mm|m|nm)(?:$|[^a-z])");
  std::smatch match;
  const std::string text = lower_case(header);
  if (!std::regex_search(text, match, kUnit)) return {};
  return match[1].length() == 3 ? "um" : match[1].str();
}

void check_header(const fs::path& file, const Line& line, std::string_view unit) {
  const std::string said = unit_in(line.text);
  if (said.empty() || said == unit) return;
  refuse(file, line,
         "says " + said + ", but the heights are read as " + std::string(unit) +
             (said == "nm" ? ": give them in um, mm or m"
                           : ": give --z-unit " + said + " of fvdctl process, stage.replay_z_unit of a configuration"));
}

/// Turns decimal commas into points where they cannot separate thousands.
void resolve_commas(const fs::path& file, std::vector<Line>& lines) {
  static const std::regex kComma("[-+]?[0-9]+,[0-9]+(?:[eE][-+]?[0-9]+)?");
  static const std::regex kThousands("[-+]?[1-9][0-9]{0,2},[0-9]{3}");
  const auto with = [&](char c) {
    return std::find_if(lines.begin(), lines.end(),
                        [c](const Line& line) { return line.text.find(c) != line.text.npos; });
  };
  const auto comma = with(',');
  if (comma == lines.end()) return;
  const bool sure = std::any_of(lines.begin(), lines.end(), [](const Line& line) {
    return std::regex_match(line.text, kComma) && !std::regex_match(line.text, kThousands);
  });
  if (with('.') != lines.end())
    refuse(file, *comma,
           "has a comma and line " + std::to_string(with('.')->number) +
               " a point: which is the decimal one is not known");
  if (!sure && std::regex_match(comma->text, kThousands)) {
    refuse(file, *comma, "can be a decimal comma or one of thousands: write a decimal point");
  }
  for (Line& line : lines) {
    if (std::regex_match(line.text, kComma)) std::replace(line.text.begin(), line.text.end(), ',', '.');
  }
}

double number_in(const fs::path& file, const Line& line) {
  const std::string_view text = line.text;
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data() + (plus ? 1 : 0), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) refuse(file, line, "is not one number");
  if (!std::isfinite(value)) refuse(file, line, "is not a finite height");
  return value;
}

}  // namespace

std::vector<double> read_z_list(const fs::path& file, std::string_view unit) {
  std::vector<Line> lines = lines_of(read_text(file));
  if (!lines.empty() && is_header(lines.front().text)) {
    check_header(file, lines.front(), unit);
    lines.erase(lines.begin());
  }
  resolve_commas(file, lines);
  std::vector<double> heights;
  for (const Line& line : lines) heights.push_back(number_in(file, line));
  return heights;
}

}  // namespace fvd
