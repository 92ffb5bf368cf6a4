#pragma once

/// The commands `fvdctl objective ...`.

#include <functional>
#include <string>

#include "daemon/ctl/fvdctl.hpp"
#include "daemon/ctl/rpc_client.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct ObjectiveArguments {
  std::string name;
  std::string person;
};

/// Adds `objective` with its commands. connect: gives a connection to the daemon. chosen: set to the command that the
/// line names.
void add_objective_commands(CLI::App& app, ObjectiveArguments& arguments, const std::function<RpcClient()>& connect,
                            const Terminal& terminal, std::function<int()>& chosen);

}  // namespace fvd::ctl
