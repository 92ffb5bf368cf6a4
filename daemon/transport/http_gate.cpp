#include "daemon/transport/http_gate.hpp"

#include <algorithm>

namespace fvd {

namespace {

constexpr std::size_t kLongestToken_bytes = 256;

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

std::string_view without_blanks(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// The name of "name:port", "[::1]:port"; empty for a text that is neither.
std::string_view name_of(std::string_view host) {
  const auto end = host.empty() || host.front() != '[' ? host.find(':') : host.find(']');
  if (end == std::string_view::npos) return !host.empty() && host.front() == '[' ? std::string_view{} : host;
  const std::string_view name = host.front() == '[' ? host.substr(0, end + 1) : host.substr(0, end);
  const std::string_view rest = host.substr(name.size());
  const bool has_port = rest.size() > 1 && rest.front() == ':' &&
                        rest.substr(1).find_first_not_of("0123456789") == std::string_view::npos;
  return rest.empty() || has_port ? name : std::string_view{};
}

/// "127.0.0.1", "[::1]": as it stands in a URL. An IPv4 address that came in by an IPv6 listener is one.
std::string url_form(std::string_view address) {
  constexpr std::string_view kMapped = "::ffff:";
  if (address.substr(0, kMapped.size()) == kMapped && address.find('.') != std::string_view::npos) {
    return std::string(address.substr(kMapped.size()));
  }
  const std::string plain(address.substr(0, address.find('%')));
  return plain.find(':') == std::string::npos ? plain : "[" + plain + "]";
}

}  // namespace

HttpGate::HttpGate(const std::vector<std::string>& hosts) {
  for (const std::string& host : hosts) hosts_.push_back(in_lower_case(host));
  for (const char* local : {"localhost", "127.0.0.1", "[::1]"}) hosts_.emplace_back(local);
}

std::optional<HttpRefusal> HttpGate::refusal_of(const HttpHead& head, std::string_view own_address) const {
  if (head.has_twice) return HttpRefusal{400, "bad_request", "a header field stands twice; send it once"};
  if (!head.host) return HttpRefusal{400, "bad_request", "the header field Host is missing; send it"};
  const std::string host = in_lower_case(*head.host);
  const std::string_view name = name_of(host);
  if (name != url_form(own_address) && std::find(hosts_.begin(), hosts_.end(), name) == hosts_.end()) {
    return HttpRefusal{403, "unknown_host",
                       "nobody is called so here; use this machine's address, or add the name to http.hosts"};
  }
  if (head.origin) {
    const std::string origin = in_lower_case(*head.origin);
    if (origin != "http://" + host && origin != "https://" + host) {
      return HttpRefusal{403, "foreign_origin",
                         "a page from elsewhere may not call this; use the page of this address"};
    }
  }
  if (head.fetch_site && *head.fetch_site != "same-origin" && *head.fetch_site != "none") {
    return HttpRefusal{403, "foreign_origin", "a page from elsewhere may not call this; use the page of this address"};
  }
  return std::nullopt;
}

bool is_json_type(std::string_view content_type) {
  return in_lower_case(without_blanks(content_type.substr(0, content_type.find(';')))) == "application/json";
}

std::optional<std::string_view> bearer_of(std::string_view authorization) {
  constexpr std::string_view kScheme = "bearer ";
  if (in_lower_case(authorization.substr(0, kScheme.size())) != kScheme) return std::nullopt;
  const std::string_view token = without_blanks(authorization.substr(kScheme.size()));
  if (token.empty() || token.size() > kLongestToken_bytes) return std::nullopt;
  return token;
}

}  // namespace fvd
