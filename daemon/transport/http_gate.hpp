#pragma once

/// What an HTTP request is refused for before its body is read: plain texts in, no sockets, no Beast.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/transport/http_refusal.hpp"

namespace fvd {

/// What is asked of a request's header. A field that stands twice is no field.
struct HttpHead {
  std::string method;                        ///< "POST"
  std::string path;                          ///< as it was sent, without the query
  std::optional<std::string> host;           ///< "localhost:7413"
  std::optional<std::string> origin;         ///< of the page that sends it
  std::optional<std::string> fetch_site;     ///< a browser's word for where the page comes from
  std::optional<std::string> content_type;   ///< "application/json; charset=utf-8"
  std::optional<std::string> authorization;  ///< "Bearer TOKEN"
  bool has_twice = false;                    ///< one of the fields above

  // Of no weight for who is let in.
  std::optional<std::string> accept_encoding{};
  std::optional<std::string> if_none_match{};
  std::optional<std::string> range{};
  std::optional<std::string> if_range{};
  std::optional<std::string> last_event_id{};
};

/// Lets nobody in whom a browser sends for a foreign page. context: thread-safe; never changes.
class HttpGate {
 public:
  /// hosts: names by which clients may call the server, beside localhost and its own addresses.
  explicit HttpGate(const std::vector<std::string>& hosts);

  /// own_address: the one that the client reached, "127.0.0.1" or "::1". A page on any host can send a request to any
  /// other, and its name may stand for an address of this machine (DNS rebinding): so Host is one that is known, and
  /// Origin and Sec-Fetch-Site, where a browser gives them, say that the page comes from here. 400, 403.
  [[nodiscard]] std::optional<HttpRefusal> refusal_of(const HttpHead& head, std::string_view own_address) const;

 private:
  std::vector<std::string> hosts_;  // lower case
};

/// True for application/json, with parameters or without, in upper or lower case.
[[nodiscard]] bool is_json_type(std::string_view content_type);

/// The token of "Bearer TOKEN"; nothing for any other text.
[[nodiscard]] std::optional<std::string_view> bearer_of(std::string_view authorization);

}  // namespace fvd
