#include "config/problem.hpp"

#include <algorithm>

namespace fvd {

bool is_reported(const Problems& problems, std::string_view pointer) noexcept {
  return std::any_of(problems.begin(), problems.end(), [pointer](const Problem& problem) {
    const std::string& place = problem.pointer;
    return pointer.starts_with(place) && (pointer.size() == place.size() || pointer[place.size()] == '/');
  });
}

std::string to_text(const Problems& problems, const std::string& source) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += source + ": " + (problem.pointer.empty() ? "" : problem.pointer + ": ") + problem.message;
  }
  return text;
}

void throw_if_any(const Problems& problems, ErrorCode code, const std::string& source) {
  if (!problems.empty()) throw Error(code, to_text(problems, source));
}

}  // namespace fvd
