#pragma once

/// The command `fvdctl jobs`.

#include <functional>
#include <string>

#include "daemon/ctl/fvdctl.hpp"
#include "daemon/ctl/rpc_client.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct JobsArguments {
  int most = 50;
  std::string part;
  std::string recipe;
  std::string verdict;
  std::string state;
  std::string from_utc;
  std::string to_utc;
  std::string text;
  bool json = false;
};

/// Adds the command. connect: gives a connection to the daemon. chosen: set to the command that the line names.
void add_history_commands(CLI::App& app, JobsArguments& arguments, const std::function<RpcClient()>& connect,
                          const Terminal& terminal, std::function<int()>& chosen);

}  // namespace fvd::ctl
