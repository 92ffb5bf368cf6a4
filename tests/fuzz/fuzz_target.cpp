/// What the target of an HTTP request is read as: nothing that leads out of a folder, no text that is none, and the
/// same once it is written and read again.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "daemon/transport/http_target.hpp"

namespace fvd::test {

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

void demand_text(const std::string& text) {
  for (const char c : text) demand(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
  (void)nlohmann::json(text).dump();  // throws for what is no UTF-8
}

/// Percent-encoded, but for slashes where they separate.
std::string encoded(const std::string& text, bool is_path) {
  constexpr std::string_view kDigits("0123456789ABCDEF");
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (is_path && c == '/') {
      plain += c;
    } else {
      plain += '%';
      plain += kDigits[byte >> 4U];
      plain += kDigits[byte & 15U];
    }
  }
  return plain;
}

void check(const HttpTarget& target) {
  demand(!target.path.empty() && target.path.front() == '/');
  demand_text(target.path);
  demand(target.path.find("//") == std::string::npos && target.path.find('\\') == std::string::npos);
  const std::string closed = target.path + '/';
  demand(closed.find("/../") == std::string::npos && closed.find("/./") == std::string::npos);
  demand(target.query.size() <= kMostQueryKeys);
  std::string again = encoded(target.path, true);
  char separator = '?';
  for (const auto& [key, value] : target.query) {
    demand(!key.empty());
    demand_text(key);
    demand_text(value);
    again += separator + encoded(key, false) + '=' + encoded(value, false);
    separator = '&';
  }
  if (again.size() > kLongestTarget_bytes) return;
  const auto read = read_target(again);
  const auto* same = std::get_if<HttpTarget>(&read);
  demand(same != nullptr && same->path == target.path && same->query == target.query);
}

}  // namespace

}  // namespace fvd::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace fvd;
  const auto read = read_target({reinterpret_cast<const char*>(bytes), size});
  if (const auto* target = std::get_if<HttpTarget>(&read)) {
    test::demand(size <= kLongestTarget_bytes);
    test::check(*target);
  } else {
    const auto& refusal = std::get<HttpRefusal>(read);
    test::demand(refusal.status == 400 || refusal.status == 414);
    test::demand(nlohmann::json::accept(refusal.body()));
  }
  return 0;
}
