#pragma once

/// What a request asks for: the target of its first line as a path and a query, decoded once. Plain texts, no sockets.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "daemon/transport/http_refusal.hpp"

namespace fvd {

inline constexpr std::size_t kLongestTarget_bytes = 2048;
inline constexpr std::size_t kMostQueryKeys = 32;

/// Of path and values: UTF-8 without control characters.
struct HttpTarget {
  std::string path;                          ///< begins with "/"; see read_target() for what it cannot hold
  std::map<std::string, std::string> query;  ///< a key without "=" has an empty value
};

/// Of "/api/v1/jobs/7/height?w=64". In the query "+" is a blank, as forms write it. Refused with 414 where it is longer
/// than kLongestTarget_bytes; with 400 where it does not begin with "/", has a fragment or bytes that belong percent-
/// encoded, an escape that is none, control characters (NUL too) or no UTF-8 once decoded, a segment "." or "..", an
/// empty segment that is not the last, a "/" or "\" inside a segment, or a key that is empty, stands twice, or is one
/// too many. What is decoded is never decoded again.
[[nodiscard]] std::variant<HttpTarget, HttpRefusal> read_target(std::string_view target);

}  // namespace fvd
