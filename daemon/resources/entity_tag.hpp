#pragma once

/// Entity tags as requests name them (RFC 9110, 13.1).

#include <string_view>

namespace fvd {

/// Whether If-None-Match names the entity: "*", or a list that has the tag, weak or not. etag: strong, in its quotes.
/// A text that is no such list names nothing from where it is wrong.
[[nodiscard]] bool names_entity(std::string_view if_none_match, std::string_view etag);

/// Whether If-Range is the same strong tag. A date is none: these answers have no date of change.
[[nodiscard]] bool is_same_entity(std::string_view if_range, std::string_view etag);

}  // namespace fvd
