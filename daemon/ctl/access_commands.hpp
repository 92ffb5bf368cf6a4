#pragma once

/// The commands `fvdctl audit`, `stop`, `token` and `kiosk-url`.

#include <filesystem>
#include <functional>
#include <string>

#include "daemon/ctl/fvdctl.hpp"
#include "daemon/ctl/rpc_client.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct AccessArguments {
  int most = 50;
  bool json = false;
  std::string name;
  std::string role;
  std::string page;
};

/// Adds the commands. connect: gives a connection to the daemon. chosen: set to the command that the line names.
void add_access_commands(CLI::App& app, AccessArguments& arguments, const std::function<RpcClient()>& connect,
                         const Terminal& terminal, std::function<int()>& chosen);

/// Says who calls, by the token in the first line of the file. Throws Error kBadInput, RpcError.
void log_in(RpcClient& client, const std::filesystem::path& token_file);

}  // namespace fvd::ctl
