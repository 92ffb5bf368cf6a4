#pragma once

/// How a command line reaches the daemon, and as whom.

#include <string>

#include "daemon/ctl/rpc_client.hpp"

namespace fvd::ctl {

struct ConnectionArguments {
  std::string address;  ///< "host:port", "http://host:port"; empty = as runtime_dir says
  std::string runtime_dir = "/run/fvd";
  std::string token_file;  ///< empty = nobody says who calls
};

/// Connects and says who calls. Throws Error kNotReady, kTimeout, kBadInput, RpcError.
[[nodiscard]] RpcClient connect(const ConnectionArguments& arguments);

/// After a refusal for the role's sake: what to do where the port would give a role that may more than the socket's.
/// Empty where it would not, or where that cannot be found out.
[[nodiscard]] std::string other_way(const ConnectionArguments& arguments);

}  // namespace fvd::ctl
