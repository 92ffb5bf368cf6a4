#pragma once

/// What Beast parses, as the gate reads it. Only for sources that speak HTTP: Beast takes half a minute to compile.

#include <chrono>
#include <optional>
#include <string>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/beast/http.hpp>

#include "daemon/transport/http_fields.hpp"
#include "daemon/transport/http_gate.hpp"

namespace fvd {

[[nodiscard]] inline HttpHead head_of(const boost::beast::http::request_header<>& request) {
  namespace http = boost::beast::http;
  HttpHead head;
  head.method = std::string(request.method_string());
  const std::string target(request.target());
  head.path = target.substr(0, target.find('?'));
  const auto take = [&](auto name, std::optional<std::string>& value) {
    const auto count = request.count(name);
    head.has_twice = head.has_twice || count > 1;
    if (count == 1) value = std::string(request.find(name)->value());
  };
  take(http::field::host, head.host);
  take(http::field::origin, head.origin);
  take("Sec-Fetch-Site", head.fetch_site);
  take(http::field::content_type, head.content_type);
  take(http::field::authorization, head.authorization);
  const auto take_single = [&](auto name, std::optional<std::string>& value) {
    if (request.count(name) == 1) value = std::string(request.find(name)->value());
  };
  take_single(http::field::accept_encoding, head.accept_encoding);
  take_single(http::field::if_none_match, head.if_none_match);
  take_single(http::field::range, head.range);
  take_single(http::field::if_range, head.if_range);
  take_single("Last-Event-ID", head.last_event_id);
  return head;
}

/// Those that every answer has.
template <typename Response>
void set_common_fields(Response& response) {
  response.set(boost::beast::http::field::date, http_date(std::chrono::system_clock::now()));
  for (const auto& [name, value] : kSecurityFields) {
    response.set(boost::beast::string_view(name.data(), name.size()),
                 boost::beast::string_view(value.data(), value.size()));
  }
}

}  // namespace fvd
