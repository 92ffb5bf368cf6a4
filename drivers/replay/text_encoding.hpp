#pragma once

/// Text files of other programs as UTF-8.

#include <string>

namespace fvd {

/// bytes: UTF-8, or UTF-16 with a byte order mark, as PowerShell and spreadsheets write it. The mark is removed; what
/// is no character becomes '?'. Throws Error kBadInput for UTF-16 without a mark, which NUL bytes give away, and for
/// half a character at the end; the caller adds the name of the file.
[[nodiscard]] std::string to_utf8(const std::string& bytes);

/// For messages: everything but printable ASCII as \xNN, at most 40 characters.
[[nodiscard]] std::string printable(const std::string& text);

}  // namespace fvd
