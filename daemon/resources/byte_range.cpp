#include "daemon/resources/byte_range.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

namespace fvd {

namespace {

/// Digits alone; the largest number for what does not fit. Nothing for any other text.
std::optional<std::uint64_t> number_of_digits(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_digit)) return std::nullopt;
  std::uint64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() ? value : std::numeric_limits<std::uint64_t>::max();
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

bool is_bytes(std::string_view unit) {
  constexpr std::string_view kBytes = "bytes";
  return std::equal(unit.begin(), unit.end(), kBytes.begin(), kBytes.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

}  // namespace

std::variant<NoRange, ByteRange, RangeBeyond> byte_range(std::string_view range, std::uint64_t size) {
  const auto equals = range.find('=');
  if (equals == std::string_view::npos || !is_bytes(without_blanks(range.substr(0, equals)))) return NoRange{};
  const std::string_view asked = without_blanks(range.substr(equals + 1));
  const auto dash = asked.find('-');
  if (dash == std::string_view::npos) return NoRange{};
  const auto first = number_of_digits(asked.substr(0, dash));
  const auto last = number_of_digits(asked.substr(dash + 1));
  if (dash == 0) {
    if (!last) return NoRange{};
    if (*last == 0 || size == 0) return RangeBeyond{};
    return ByteRange{size - std::min(*last, size), size - 1};
  }
  if (!first || (!last && dash + 1 != asked.size())) return NoRange{};
  if (last && *last < *first) return NoRange{};
  if (*first >= size) return RangeBeyond{};
  return ByteRange{*first, last ? std::min(*last, size - 1) : size - 1};
}

}  // namespace fvd
