#include "daemon/ctl/rpc_client.hpp"

#include "core/base/error.hpp"
#include "daemon/ctl/http_exchange.hpp"

namespace fvd::ctl {

namespace {

[[noreturn]] void refuse_reply(const std::string& line, const std::string& problem) {
  throw Error(ErrorCode::kInternal, "the reply " + problem + ": " + line.substr(0, 200));
}

[[noreturn]] void throw_error(const Json& error, const std::string& line) {
  if (!error.is_object() || !error.contains("code") || !error["code"].is_number_integer() ||
      !error.contains("message") || !error["message"].is_string()) {
    refuse_reply(line, "has an error that is not of JSON-RPC 2.0");
  }
  throw RpcError(error["code"].get<int>(), error["message"].get<std::string>(), error.value("data", Json()));
}

}  // namespace

RpcClient::RpcClient(const RpcEndpoint& endpoint, std::chrono::milliseconds connect_timeout)
    : socket_(endpoint, connect_timeout), is_http_(endpoint.is_http) {}

void RpcClient::log_in(const std::string& token) {
  if (is_http_) {
    token_ = token;
  } else {
    (void)call("session.login", {{"token", token}});
  }
}

Json RpcClient::call(const std::string& method, const Json& params, std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  const int id = ++last_id_;
  const Json request{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}};
  const std::string text = request.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (!is_http_) socket_.send_line(text, timeout);
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    const std::string line = is_http_ ? http_exchange(socket_, text, token_, timeout) : socket_.receive_line(left);
    if (line.starts_with("HTTP/")) {
      throw Error(ErrorCode::kBadInput,
                  socket_.peer() + " answers in HTTP: give --address http://" + socket_.peer() + " if it is an fvd");
    }
    Json reply = Json::parse(line, nullptr, false);
    if (!reply.is_object() || reply.value("jsonrpc", Json()) != "2.0") refuse_reply(line, "is not JSON-RPC 2.0");
    if (reply.contains("method")) continue;  // a notification
    // A request that the daemon could not even parse is answered with id null.
    const Json reply_id = reply.value("id", Json());
    if (reply.contains("error") && (reply_id == id || reply_id.is_null())) throw_error(reply["error"], line);
    if (reply_id != id) refuse_reply(line, "answers another request");
    if (!reply.contains("result")) refuse_reply(line, "has neither result nor error");
    return std::move(reply["result"]);
  }
}

}  // namespace fvd::ctl
