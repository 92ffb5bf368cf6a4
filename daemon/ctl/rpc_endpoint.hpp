#pragma once

/// Where the daemon listens.

#include <filesystem>
#include <string>
#include <string_view>

namespace fvd::ctl {

struct RpcEndpoint {
  std::string host;
  int port = 0;

  [[nodiscard]] std::string text() const;  ///< "host:port", "[host]:port" for IPv6
};

/// "host:port", "[::1]:port". Throws Error kBadInput.
[[nodiscard]] RpcEndpoint parse_endpoint(std::string_view text);

/// From <runtime_dir>/rpc.json {"address", "port"}, which the daemon writes when it listens.
/// Throws Error kNotReady if there is no such file (is fvd running?), kBadInput if it cannot be understood.
[[nodiscard]] RpcEndpoint read_endpoint(const std::filesystem::path& runtime_dir);

}  // namespace fvd::ctl
