#include "daemon/transport/foreign_protocol.hpp"

#include <algorithm>
#include <array>

namespace fvd {

namespace {

constexpr char kTlsHandshake = '\x16';
constexpr std::array<std::string_view, 10> kHttpMethods{"GET",     "HEAD",    "POST",  "PUT",   "DELETE",
                                                        "CONNECT", "OPTIONS", "TRACE", "PATCH", "PRI"};

/// The set of characters that a method may consist of (RFC 9110, token).
bool is_token_character(char c) noexcept {
  const bool letter_or_digit = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return letter_or_digit || std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool equal_in_any_case(std::string_view text, std::string_view upper) noexcept {
  const auto to_upper = [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; };
  return std::equal(text.begin(), text.end(), upper.begin(), upper.end(),
                    [&](char a, char b) { return to_upper(a) == b; });
}

}  // namespace

bool begins_foreign_protocol(std::string_view line) noexcept {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  if (line.empty()) return false;
  if (line.front() == kTlsHandshake) return true;
  const auto end = std::find_if_not(line.begin(), line.end(), is_token_character);
  const std::string_view method = line.substr(0, static_cast<std::size_t>(end - line.begin()));
  if (method.empty() || end == line.end() || (*end != ' ' && *end != '\t')) return false;
  // A page may invent methods; the version after them gives the request away.
  return line.find(" HTTP/", method.size()) != std::string_view::npos ||
         std::any_of(kHttpMethods.begin(), kHttpMethods.end(),
                     [&](std::string_view known) { return equal_in_any_case(method, known); });
}

}  // namespace fvd
