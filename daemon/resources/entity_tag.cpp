#include "daemon/resources/entity_tag.hpp"

#include <cstddef>

namespace fvd {

namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view trimmed_front(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

std::string_view trimmed_both(std::string_view text) {
  text = trimmed_front(text);
  const auto last = text.find_last_not_of(kBlanks);
  return last == std::string_view::npos ? std::string_view() : text.substr(0, last + 1);
}

}  // namespace

bool names_entity(std::string_view if_none_match, std::string_view etag) {
  std::string_view rest = trimmed_both(if_none_match);
  if (rest == "*") return true;
  while (!rest.empty()) {
    if (rest.starts_with(',')) {  // an empty element is allowed
      rest = trimmed_front(rest.substr(1));
      continue;
    }
    if (rest.starts_with("W/")) rest.remove_prefix(2);
    if (!rest.starts_with('"')) return false;
    const auto end = rest.find('"', 1);
    if (end == std::string_view::npos) return false;
    if (rest.substr(0, end + 1) == etag) return true;
    rest = trimmed_front(rest.substr(end + 1));
    if (!rest.empty() && !rest.starts_with(',')) return false;
  }
  return false;
}

bool is_same_entity(std::string_view if_range, std::string_view etag) { return trimmed_both(if_range) == etag; }

}  // namespace fvd
