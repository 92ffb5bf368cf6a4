#pragma once

/// `fvdctl setup`: the questions of daemon/setup on a terminal, or their answers from a script.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct SetupArguments {
  std::filesystem::path out = "/etc/fvd/fvd.json";
  std::filesystem::path drives = "/etc/fvd/drives";
  std::filesystem::path pictures = ".";
  std::vector<std::string> interfaces;  ///< to look for cameras; empty = all but the loopback
  bool no_search = false;
  bool simulated = false;
  bool json = false;
};

/// Adds `setup`. chosen: set to it if the line names it. Its answers come from terminal.in_fd, one a line; where they
/// end before the setup does, nothing is written. A terminal's are read from when its question is shown, and one that
/// is refused is asked for again; of a script or a program it ends the setup.
void add_setup_command(CLI::App& app, SetupArguments& arguments, const Terminal& terminal,
                       std::function<int()>& chosen);

}  // namespace fvd::ctl
