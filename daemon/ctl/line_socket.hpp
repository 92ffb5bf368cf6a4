#pragma once

/// A TCP connection, or one by a unix socket, that carries lines of text; every call has a deadline.

#include <chrono>
#include <string>
#include <string_view>

#include "daemon/base/unique_fd.hpp"
#include "daemon/ctl/rpc_endpoint.hpp"

namespace fvd::ctl {

/// context: one thread at a time.
class LineSocket {
 public:
  static constexpr std::size_t kMaxLineBytes = std::size_t{16} << 20U;

  /// Connects. Throws Error kNotReady: refused, unreachable, unknown host, or no answer in time.
  LineSocket(const RpcEndpoint& endpoint, std::chrono::milliseconds timeout);

  /// Sends one line; the terminator is added. Throws Error kNotReady (closed), kTimeout.
  void send_line(std::string_view line, std::chrono::milliseconds timeout);

  /// Sends the bytes as they are. Throws as send_line().
  void send_bytes(std::string_view bytes, std::chrono::milliseconds timeout);

  /// What comes next, at least one byte. Throws as receive_line().
  [[nodiscard]] std::string receive_some(std::chrono::milliseconds timeout);

  /// The other end, "host:port".
  [[nodiscard]] std::string peer() const { return endpoint_.text(); }

  /// The next line without its LF or CRLF, empty lines skipped. Throws Error kNotReady (closed, also in the middle of a
  /// line), kTimeout, kBadInput for a line over kMaxLineBytes.
  [[nodiscard]] std::string receive_line(std::chrono::milliseconds timeout);

 private:
  [[nodiscard]] bool take_line(std::string& line);

  RpcEndpoint endpoint_;
  UniqueFd socket_;
  std::string received_;
  std::size_t searched_ = 0;  // bytes of received_ known to hold no line end
};

}  // namespace fvd::ctl
