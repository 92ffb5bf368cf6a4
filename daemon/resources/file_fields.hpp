#pragma once

/// Fields of the answer that carries a file.

#include <string>
#include <string_view>

namespace fvd {

/// By the name's ending; application/octet-stream for those that no browser shows.
[[nodiscard]] std::string content_type_of(std::string_view file_name);

/// attachment with the name, in ASCII and, where it has other characters, percent-encoded beside it (RFC 6266). No
/// character of a name can end the text or the field.
[[nodiscard]] std::string content_disposition(std::string_view file_name);

}  // namespace fvd
