#include "daemon/resources/file_fields.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace fvd {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kTypes{{{".csv", "text/csv; charset=utf-8"},
                                                                               {".json", "application/json"},
                                                                               {".pdf", "application/pdf"},
                                                                               {".png", "image/png"},
                                                                               {".tiff", "image/tiff"},
                                                                               {".txt", "text/plain; charset=utf-8"}}};

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }
/// Means itself in a quoted text and in a percent-encoded one.
bool is_plain(char c) { return is_letter_or_digit(c) || c == '.' || c == '-' || c == '_'; }

std::string percent_encoded(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (is_plain(c)) {
      encoded += c;
    } else {
      encoded += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return encoded;
}

}  // namespace

std::string content_type_of(std::string_view file_name) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                  [file_name](const auto& type) { return file_name.ends_with(type.first); });
  return std::string(found == kTypes.end() ? "application/octet-stream" : found->second);
}

std::string content_disposition(std::string_view file_name) {
  std::string ascii(file_name);
  std::replace_if(
      ascii.begin(), ascii.end(), [](char c) { return !is_plain(c); }, '_');
  std::string field = "attachment; filename=\"" + ascii + "\"";
  if (ascii != file_name) field += "; filename*=UTF-8''" + percent_encoded(file_name);
  return field;
}

}  // namespace fvd
