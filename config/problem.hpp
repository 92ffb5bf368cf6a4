#pragma once

/// What is wrong with a document, and where.

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fvd {

struct Problem {
  std::string pointer;  ///< JSON pointer (RFC 6901), e.g. "/stage/min_um"; empty = the whole document
  std::string message;  ///< says the value and what would be accepted

  bool operator==(const Problem&) const = default;
};

using Problems = std::vector<Problem>;

/// Whether one of the problems is about the value at this place, or about an object that it stands in. A structure read
/// from the document holds something else there, so nothing that rests on the value can be judged.
[[nodiscard]] bool is_reported(const Problems& problems, std::string_view pointer) noexcept;

/// One line per problem: "<source>: <pointer>: <message>".
[[nodiscard]] std::string to_text(const Problems& problems, const std::string& source);

/// Throws Error `code` with all problems if there are any.
void throw_if_any(const Problems& problems, ErrorCode code, const std::string& source);

}  // namespace fvd
