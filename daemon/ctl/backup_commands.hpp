#pragma once

/// The commands `fvdctl backup` and `fvdctl restore`: without the daemon's help, on its machine.

#include <functional>
#include <string>

#include "daemon/ctl/fvdctl.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct BackupArguments {
  std::string folder;
  std::string config = "/etc/fvd/fvd.json";
  bool results = false;
};

/// chosen: set to the command that the line names.
void add_backup_commands(CLI::App& app, BackupArguments& arguments, const Terminal& terminal,
                         std::function<int()>& chosen);

}  // namespace fvd::ctl
