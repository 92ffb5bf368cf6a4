#include "drivers/replay/name_fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <tuple>
#include <utility>

namespace fvd {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

std::size_t end_of_digits(std::string_view text, std::size_t from) {
  while (from < text.size() && is_digit(text[from])) ++from;
  return from;
}

/// The point or comma at `at` joins digits to one decimal number, of which `begin` is the first digit.
bool joins_decimal(std::string_view stem, std::size_t begin, std::size_t at) {
  if (at + 1 >= stem.size() || !is_digit(stem[at + 1])) return false;
  const std::size_t end = end_of_digits(stem, at + 1);
  if (stem[at] == ',') return leading_unit_um(stem.substr(end)).has_value();
  if (stem[at] != '.') return false;
  const bool chain_before = begin >= 2 && stem[begin - 1] == '.' && is_digit(stem[begin - 2]);
  const bool chain_after = end + 1 < stem.size() && stem[end] == '.' && is_digit(stem[end + 1]);
  return !chain_before && !chain_after;  // 12.30.05 is no decimal number
}

/// Takes the sign off the end of the text before a number.
char take_sign(std::string& text, bool after_number) {
  constexpr std::string_view kMinus = "\xE2\x88\x92";  // U+2212
  if (text.ends_with(kMinus)) {
    text.resize(text.size() - kMinus.size());
    return '-';
  }
  if (text.empty() || (text.back() != '-' && text.back() != '+')) return '\0';
  if (after_number && text.size() == 1) return '\0';  // 2026-11-23
  const char sign = text.back();
  text.pop_back();
  return sign;
}

std::string_view without_zeros_before(std::string_view digits) {
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string_view::npos ? std::string_view{} : digits.substr(first);
}

std::string_view without_zeros_after(std::string_view digits) {
  return digits.substr(0, digits.find_last_not_of('0') + 1);
}

}  // namespace

double NameNumber::value() const {
  const std::string number = digits + "." + (fraction.empty() ? "0" : fraction);
  double result = 0.0;
  std::from_chars(number.data(), number.data() + number.size(), result);
  return sign == '-' ? -result : result;
}

std::string NameNumber::text() const {
  return (sign == '\0' ? "" : std::string(1, sign)) + digits + (fraction.empty() ? "" : "." + fraction);
}

std::weak_ordering compare(const NameNumber& a, const NameNumber& b) {
  const auto size = [](const NameNumber& number) {
    const std::string_view digits = without_zeros_before(number.digits);
    return std::tuple(digits.size(), digits, without_zeros_after(number.fraction));
  };
  const auto zero = std::tuple(std::size_t{0}, std::string_view{}, std::string_view{});
  const bool below_a = a.sign == '-' && size(a) != zero;
  const bool below_b = b.sign == '-' && size(b) != zero;
  if (below_a != below_b) return below_a ? std::weak_ordering::less : std::weak_ordering::greater;
  return below_a ? size(b) <=> size(a) : size(a) <=> size(b);
}

std::string NameFields::skeleton() const {
  std::string result;
  for (const std::string& text : texts) result += text + '\0';
  return result;
}

std::string NameFields::words() const {
  std::string result;
  for (const std::string& text : texts) std::copy_if(text.begin(), text.end(), std::back_inserter(result), is_letter);
  return lower_case(result);
}

NameFields name_fields(std::string_view stem) {
  NameFields fields;
  std::string text;
  for (std::size_t at = 0; at < stem.size();) {
    if (!is_digit(stem[at])) {
      text += stem[at++];
      continue;
    }
    NameNumber number;
    number.sign = take_sign(text, !fields.numbers.empty());
    const std::size_t end = end_of_digits(stem, at);
    number.digits = stem.substr(at, end - at);
    std::size_t next = end;
    if (joins_decimal(stem, at, end)) {
      next = end_of_digits(stem, end + 1);
      number.fraction = stem.substr(end + 1, next - end - 1);
    }
    fields.texts.push_back(std::exchange(text, {}));
    fields.numbers.push_back(std::move(number));
    at = next;
  }
  fields.texts.push_back(std::move(text));
  return fields;
}

std::optional<double> leading_unit_um(std::string_view text) {
  // micro is a sign of its own or the Greek letter
  constexpr std::array<std::pair<std::string_view, double>, 7> kUnits{{{"um", 1.0},
                                                                       {"\xC2\xB5m", 1.0},
                                                                       {"\xCE\xBCm", 1.0},
                                                                       {"microns", 1.0},
                                                                       {"micron", 1.0},
                                                                       {"mm", 1e3},
                                                                       {"nm", 1e-3}}};
  if (text.starts_with(' ') || text.starts_with('_')) text.remove_prefix(1);
  const std::string lower = lower_case(text.substr(0, 8));
  for (const auto& [name, um] : kUnits) {
    if (lower.starts_with(name) && (text.size() == name.size() || !is_letter(text[name.size()]))) return um;
  }
  return std::nullopt;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string plain_extension(const std::string& filename) {
  const std::string extension = lower_case(std::filesystem::path(filename).extension().string());
  if (extension == ".tiff") return ".tif";
  return extension == ".jpeg" ? ".jpg" : extension;
}

}  // namespace fvd
