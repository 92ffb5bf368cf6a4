#include "config/problem.hpp"

namespace fvd {

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
