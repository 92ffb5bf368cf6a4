#include "daemon/resources/height_query.hpp"

#include <algorithm>
#include <charconv>

namespace fvd {

namespace {

constexpr int kLargestNumber = 1'000'000'000;

/// Decimal digits alone.
std::optional<int> whole_number(const std::string& text) {
  int value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = read.ec == std::errc() && read.ptr == text.data() + text.size() && !text.starts_with('-');
  if (!is_whole || value > kLargestNumber) return std::nullopt;
  return value;
}

}  // namespace

std::variant<HeightQuery, std::string> read_height_query(const std::map<std::string, std::string>& query) {
  HeightQuery read;
  for (const auto& [key, text] : query) {
    if (key == "v") continue;  // browsers keep an answer for ever: another version is another address
    if (key == "kind") {
      const auto kind = map_kind_from_name(text);
      if (!kind) return "kind must be height, sigma, texture or reason";
      read.kind = *kind;
      continue;
    }
    const auto value = whole_number(text);
    const bool is_size = key == "w" || key == "h" || key == "max";
    if (!is_size && key != "x" && key != "y") return "the query has a key that is none of kind, x, y, w, h, max, v";
    if (!value || (is_size && *value == 0)) return key + " must be a whole number" + (is_size ? " above 0" : "");
    if (key == "x") read.x = *value;
    if (key == "y") read.y = *value;
    if (key == "w") read.width = *value;
    if (key == "h") read.height = *value;
    if (key == "max") read.most = std::min(*value, kLongestViewSide);
  }
  return read;
}

std::optional<ViewWindow> window_in(const HeightQuery& query, const GridSize& size) {
  if (query.x >= size.width || query.y >= size.height) return std::nullopt;
  const ViewWindow window{query.x, query.y, query.width.value_or(size.width - query.x),
                          query.height.value_or(size.height - query.y)};
  if (window.width > size.width - window.x || window.height > size.height - window.y) return std::nullopt;
  return window;
}

}  // namespace fvd
