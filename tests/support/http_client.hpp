#pragma once

/// An HTTP client of the plainest kind: what a test writes is what is sent.

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "tests/support/line_client.hpp"

namespace fvd {

struct HttpReply {
  int status = 0;
  std::map<std::string, std::string> fields;  ///< names in lower case
  std::string body;
};

class HttpClient {
 public:
  explicit HttpClient(int port) : client_(port), port_(port) {}

  /// A request as curl sends it; more: lines of the header, each with its end.
  [[nodiscard]] std::string request(const std::string& body, const std::string& more = "") const {
    return "POST /api/jsonrpc HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
           "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + more +
           "\r\n" + body;
  }
  /// A GET as a browser sends it for a page of this address.
  [[nodiscard]] std::string get_request(const std::string& target, const std::string& more = "",
                                        const std::string& method = "GET") const {
    return method + " " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
           "\r\nSec-Fetch-Site: same-origin\r\n" + more + "\r\n";
  }
  std::optional<HttpReply> get(const std::string& target, const std::string& more = "") {
    return ask(get_request(target, more));
  }
  std::optional<HttpReply> head(const std::string& target, const std::string& more = "") {
    send(get_request(target, more, "HEAD"));
    return head_reply();
  }
  bool send(const std::string& bytes) { return client_.send(bytes); }
  /// Nothing if the server closes, or says nothing in time.
  std::optional<HttpReply> reply(std::chrono::milliseconds within = std::chrono::seconds(15)) {
    auto reply = head_reply(within);
    if (!reply) return std::nullopt;
    const auto length = reply->fields.find("content-length");
    if (length == reply->fields.end()) return reply;
    const auto body = body_bytes(static_cast<std::size_t>(std::atoll(length->second.c_str())), within);
    if (!body) return std::nullopt;
    reply->body = *body;
    return reply;
  }
  /// Up to the body, which the answer to HEAD has not.
  std::optional<HttpReply> head_reply(std::chrono::milliseconds within = std::chrono::seconds(15)) {
    HttpReply reply;
    auto line = client_.line(within);
    if (!line || line->rfind("HTTP/1.1 ", 0) != 0) return std::nullopt;
    reply.status = std::atoi(line->c_str() + 9);
    for (line = client_.line(within); line && *line != "\r"; line = client_.line(within)) {
      const auto colon = line->find(": ");
      std::string name = line->substr(0, colon);
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
      reply.fields[name] = line->substr(colon + 2, line->size() - colon - 3);
    }
    if (!line) return std::nullopt;
    return reply;
  }
  /// More of a body, as LineClient gives it.
  std::optional<std::string> line(std::chrono::milliseconds within = std::chrono::seconds(15)) {
    return client_.line(within);
  }
  std::optional<std::string> body_bytes(std::size_t count,
                                        std::chrono::milliseconds within = std::chrono::seconds(15)) {
    return client_.bytes(count, within);
  }
  std::optional<HttpReply> ask(const std::string& bytes) {
    send(bytes);
    return reply();
  }
  std::optional<HttpReply> call(const std::string& body, const std::string& more = "") {
    return ask(request(body, more));
  }
  bool closes() { return client_.closes(); }

 private:
  LineClient client_;
  int port_;
};

}  // namespace fvd
