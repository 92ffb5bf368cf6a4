#pragma once

/// JSON-RPC 2.0 over one connection, one request at a time; a message is a line, or a body of HTTP.

#include <chrono>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/ctl/line_socket.hpp"

namespace fvd::ctl {

using Json = nlohmann::ordered_json;

inline constexpr int kNotAllowedCode = 1004;

/// The daemon answered with an error object. what() is its message.
class RpcError : public std::runtime_error {
 public:
  RpcError(int code, const std::string& message, Json data)
      : std::runtime_error(message), code_(code), data_(std::move(data)) {}
  [[nodiscard]] int code() const noexcept { return code_; }
  [[nodiscard]] const Json& data() const noexcept { return data_; }  ///< null if there was none

 private:
  int code_;
  Json data_;
};

/// context: one thread at a time.
class RpcClient {
 public:
  static constexpr std::chrono::milliseconds kConnectTimeout{3000};
  static constexpr std::chrono::milliseconds kReplyTimeout{5000};

  /// Throws Error kNotReady.
  explicit RpcClient(const RpcEndpoint& endpoint, std::chrono::milliseconds connect_timeout = kConnectTimeout);

  /// Says who calls from now on. Throws as call().
  void log_in(const std::string& token);

  /// Returns the result. params: object or array. Notifications that arrive meanwhile are skipped.
  /// Throws RpcError for an error reply; Error kNotReady, kTimeout; kBadInput for one in HTTP; kInternal for a reply
  /// that is not JSON-RPC 2.0 or answers another request.
  [[nodiscard]] Json call(const std::string& method, const Json& params = Json::object(),
                          std::chrono::milliseconds timeout = kReplyTimeout);

 private:
  LineSocket socket_;
  bool is_http_;
  std::string token_;  // that goes with each request of HTTP
  int last_id_ = 0;
};

}  // namespace fvd::ctl
