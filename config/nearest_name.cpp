#include "config/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace fvd {

namespace {

/// A longer name is no slip of the pen, and to compare a mebibyte with each known name takes long.
constexpr std::size_t kLongestSlip_bytes = 128;

/// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

/// What ends where the words of these names go on: "max" of "max_um", "serial" of "serial_baud" and "serial_device".
std::vector<std::string> longer_names(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kMost = 3;
  const std::string beginning = std::string(name) + "_";
  std::vector<std::string> longer;
  for (const std::string& one : known) {
    if (name.empty() || longer.size() == kMost || !one.starts_with(beginning)) continue;
    longer.push_back(one);
  }
  return longer;
}

}  // namespace

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  if (name.size() > kLongestSlip_bytes) return "";
  const std::string* nearest = nullptr;
  std::size_t fewer_than = 2 + name.size() / 3;
  for (const std::string& one : known) {
    const std::size_t distance = edit_distance(name, one);
    if (distance >= fewer_than) continue;
    fewer_than = distance;
    nearest = &one;
  }
  if (nearest != nullptr) return "; did you mean '" + *nearest + "'?";
  std::string text;
  for (const std::string& longer : longer_names(name, known)) {
    text += (text.empty() ? "; did you mean '" : " or '") + longer + "'";
  }
  return text.empty() ? "" : text + "?";
}

}  // namespace fvd
