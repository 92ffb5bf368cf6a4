#include "daemon/transport/line_mistakes.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace fvd {

namespace {

constexpr std::string_view kUtf16 =
    "this is UTF-16: send each character as one byte (ASCII, UTF-8), and LF at the end of the text";
constexpr std::string_view kLength =
    "a length stands before the JSON text: send the text alone, and LF at its end in place of a length";
constexpr std::string_view kNoEnd =
    "the JSON text has no end of line, and was not executed: send LF, CR or NUL behind it";
constexpr std::string_view kHalf = "the connection was closed within a line, which was not executed";

constexpr std::size_t kLongestBinary_bytes = 4;
constexpr std::size_t kLongestDecimal_bytes = 12;
constexpr std::string_view kDigits = "0123456789";

/// What encoding marks and a client's text begin with.
bool begins_utf16(std::string_view line) noexcept {
  return line.substr(0, 2) == "\xff\xfe" || line.substr(0, 2) == "\xfe\xff";
}

/// A header as some protocols have before JSON.
bool is_length_header(std::string_view line) noexcept {
  constexpr std::string_view kHeader = "content-length:";
  return line.size() >= kHeader.size() &&
         std::equal(kHeader.begin(), kHeader.end(), line.begin(), [](char expected, char c) {
           return expected == (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
         });
}

/// A few bytes, or digits, and then the beginning of an object or a list.
bool has_prefix(std::string_view line) noexcept {
  const auto begin = line.find_first_of("{[");
  if (begin == 0 || begin == std::string_view::npos) return false;
  const std::string_view prefix = line.substr(0, begin);
  if (prefix.find_first_not_of(" \t") == std::string_view::npos || prefix == "\xef\xbb\xbf") return false;
  if (prefix.front() == '"') return false;  // a JSON text, if no request
  if (prefix.size() <= kLongestBinary_bytes) return true;
  const auto digits = std::min(prefix.find_first_not_of(kDigits), prefix.size());
  return prefix.size() <= kLongestDecimal_bytes && digits > 0 &&
         prefix.find_first_not_of(" \t:;,", digits) == std::string_view::npos;
}

}  // namespace

std::optional<std::string_view> mistake_in(std::string_view line, LineEnd end) noexcept {
  if (begins_utf16(line)) return kUtf16;
  // Half of a two-byte character, or the low byte of a length: NUL ends a line.
  if (end == LineEnd::kNul && line.size() == 1) return line == "{" || line == "[" ? kUtf16 : kLength;
  const bool is_number = end != LineEnd::kNone && line.find_first_not_of(kDigits) == std::string_view::npos;
  if (is_number || has_prefix(line) || is_length_header(line)) return kLength;
  return std::nullopt;
}

std::string_view missing_end(std::string_view line) { return nlohmann::json::accept(line) ? kNoEnd : kHalf; }

}  // namespace fvd
