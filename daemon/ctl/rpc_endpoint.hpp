#pragma once

/// Where the daemon listens.

#include <filesystem>
#include <string>
#include <string_view>

namespace fvd::ctl {

struct RpcEndpoint {
  std::string host;
  int port = 0;
  std::string socket{};  ///< path of a unix socket; where it is given, host and port do not count
  bool is_http = false;  ///< JSON-RPC by HTTP, not by lines

  [[nodiscard]] std::string text() const;  ///< "host:port", "[host]:port" for IPv6, the socket's path
};

/// "host:port", "[::1]:port", "http://host:port". Throws Error kBadInput.
[[nodiscard]] RpcEndpoint parse_endpoint(std::string_view text);

/// From <runtime_dir>/rpc.json {"address", "port", "socket"}, which the daemon writes when it listens: the socket where
/// its file exists, else the port.
/// Throws Error kNotReady if there is no such file (is fvd running?), kBadInput if it cannot be understood.
[[nodiscard]] RpcEndpoint read_endpoint(const std::filesystem::path& runtime_dir);

}  // namespace fvd::ctl
