#include "daemon/ctl/http_exchange.hpp"

#include <sstream>
#include <utility>  // before Asio 1.74, which forgets it

#include <boost/beast/http.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "daemon/ctl/rpc_client.hpp"

namespace fvd::ctl {

namespace http = boost::beast::http;

namespace {

constexpr std::size_t kLongestForeignText = 200;

/// What the server says of a refusal: its message where it sends one, else the beginning of its text.
std::string reason_of(const http::response<http::string_body>& answer) {
  const auto json = nlohmann::json::parse(answer.body(), nullptr, false);
  if (json.is_object() && json.contains("message") && json["message"].is_string()) {
    return json["message"].get<std::string>();
  }
  return answer.body().substr(0, kLongestForeignText);
}

http::response<http::string_body> receive(LineSocket& socket, std::chrono::milliseconds timeout) {
  http::response_parser<http::string_body> parser;
  parser.eager(true);
  parser.body_limit(LineSocket::kMaxLineBytes);
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::string unread;
  while (!parser.is_done()) {
    const auto left = deadline - std::chrono::steady_clock::now();
    unread += socket.receive_some(std::chrono::ceil<std::chrono::milliseconds>(left));
    boost::system::error_code error;
    const std::size_t used = parser.put(boost::asio::buffer(unread), error);
    unread.erase(0, used);
    if (error && error != http::error::need_more) {
      throw Error(ErrorCode::kBadInput, socket.peer() + " does not answer in HTTP (" + error.message() +
                                            "): is it an fvd, and is it its http.port?");
    }
  }
  return parser.release();
}

}  // namespace

std::string http_exchange(LineSocket& socket, std::string_view body, const std::string& token,
                          std::chrono::milliseconds timeout) {
  http::request<http::string_body> request{http::verb::post, "/api/jsonrpc", 11};
  request.set(http::field::host, socket.peer());
  request.set(http::field::content_type, "application/json");
  if (!token.empty()) request.set(http::field::authorization, "Bearer " + token);
  request.body() = body;
  request.prepare_payload();
  std::ostringstream bytes;
  bytes << request;
  socket.send_bytes(bytes.str(), timeout);
  const auto answer = receive(socket, timeout);
  if (http::to_status_class(answer.result()) != http::status_class::successful) {
    const std::string refusal =
        "http://" + socket.peer() + " refused with status " + std::to_string(answer.result_int()) + ": ";
    if (answer.result() == http::status::unauthorized || answer.result() == http::status::forbidden) {
      throw RpcError(kNotAllowedCode, refusal + reason_of(answer), {});  // as by the other ways
    }
    throw Error(ErrorCode::kNotReady, refusal + reason_of(answer));
  }
  return answer.body();
}

}  // namespace fvd::ctl
