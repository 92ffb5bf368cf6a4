#include "daemon/transport/http_target.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace fvd {

namespace {

/// Never leaves this file.
struct Refused {
  std::string why;
};

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

bool is_utf8(const std::string& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// What a browser lets stand in a target as it is; "%" too, which begins an escape.
bool is_plain(char c) {
  constexpr std::string_view kNotPlain("\"#<>");
  return c > ' ' && c < 0x7f && kNotPlain.find(c) == std::string_view::npos;
}

std::string decoded(std::string_view text, bool plus_is_blank) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_blank) {
      plain += ' ';
    } else if (text[i] != '%') {
      plain += text[i];
    } else {
      const auto high = i + 2 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
      const auto low = high ? hex_digit(text[i + 2]) : std::nullopt;
      if (!low) throw Refused{"has a '%' without two hexadecimal digits; write %25 for a percent sign"};
      plain += static_cast<char>(*high * 16 + *low);
      i += 2;
    }
  }
  if (std::any_of(plain.begin(), plain.end(), is_control)) throw Refused{"has a control character; leave it out"};
  if (!is_utf8(plain)) throw Refused{"is not UTF-8 once decoded; encode texts as UTF-8"};
  return plain;
}

/// The parts between separators; one empty part of an empty text.
template <typename Take>
void each_part(std::string_view text, char separator, Take take) {
  for (;;) {
    const auto end = text.find(separator);
    take(text.substr(0, end), end == std::string_view::npos);
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

std::string read_path(std::string_view text) {
  std::string path;
  each_part(text.substr(1), '/', [&path](std::string_view part, bool is_last) {
    const std::string segment = decoded(part, false);
    if (segment.empty() && !is_last) throw Refused{"has an empty name between two '/'; write one '/'"};
    if (segment == "." || segment == "..") throw Refused{"goes up or stays; write the path itself"};
    if (segment.find_first_of("/\\") != std::string::npos) throw Refused{"has a '/' or '\\' inside a name"};
    path += '/' + segment;
  });
  return path;
}

std::map<std::string, std::string> read_query(std::string_view text) {
  std::map<std::string, std::string> query;
  if (text.empty()) return query;
  each_part(text, '&', [&query](std::string_view part, bool) {
    const auto equals = part.find('=');
    std::string key = decoded(part.substr(0, equals), true);
    if (key.empty()) throw Refused{"has a value without a key; write key=value"};
    std::string value = equals == std::string_view::npos ? "" : decoded(part.substr(equals + 1), true);
    if (!query.emplace(std::move(key), std::move(value)).second) {
      throw Refused{"has a key twice; write it once"};
    }
    if (query.size() > kMostQueryKeys) {
      throw Refused{"has more than " + std::to_string(kMostQueryKeys) + " keys; leave some out"};
    }
  });
  return query;
}

}  // namespace

std::variant<HttpTarget, HttpRefusal> read_target(std::string_view target) {
  if (target.size() > kLongestTarget_bytes) {
    return HttpRefusal{
        414, "target_too_long",
        "what is asked for has more than " + std::to_string(kLongestTarget_bytes) + " bytes; ask for less at a time"};
  }
  try {
    if (target.empty() || target.front() != '/') throw Refused{"does not begin with '/'; ask for a path"};
    if (!std::all_of(target.begin(), target.end(), is_plain)) {
      throw Refused{"has characters that belong percent-encoded (%20 for a blank), or a fragment"};
    }
    const auto question = target.find('?');
    HttpTarget read{read_path(target.substr(0, question)), {}};
    if (question != std::string_view::npos) read.query = read_query(target.substr(question + 1));
    return read;
  } catch (const Refused& refused) {
    return HttpRefusal{400, "bad_target", "what is asked for " + refused.why};
  }
}

}  // namespace fvd
