#pragma once

/// The commands `fvdctl recipe ...`.

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/ctl/fvdctl.hpp"
#include "daemon/ctl/rpc_client.hpp"
#include "daemon/ctl/suggest_filters_command.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct RecipeArguments {
  std::string id;
  std::string file;
  std::string author;
  std::string comment;
  std::int64_t base_version = 0;  ///< that the change was made from; 0 = the shipped recipe, or a new one
  std::int64_t version = 0;       ///< to restore
  SuggestFiltersArguments filters;
};

/// Adds `recipe` with its commands. connect: called by those that need the daemon. chosen: set to the command that the
/// line names.
void add_recipe_commands(CLI::App& app, RecipeArguments& arguments, const std::function<RpcClient()>& connect,
                         const Terminal& terminal, std::function<int()>& chosen);

}  // namespace fvd::ctl
