#pragma once

/// `fvdctl devices` and `fvdctl camera set-ip`: what is plugged in, and cameras with an address that does not fit.

#include <functional>
#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"
#include "drivers/common/driver_config.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct DevicesArguments {
  std::vector<std::string> interfaces;  ///< names or addresses; empty = all but the loopback
  std::vector<std::string> at;          ///< further addresses to be asked
  std::string units;                    ///< "N" or "N-M"; empty = no drive is looked for
  std::vector<std::string> tcp;         ///< HOST or HOST:PORT
  std::vector<std::string> serial;      ///< serial ports
  StageConfig line;                     ///< settings of those
  int response_timeout_ms = 200;
  bool json = false;

  std::string camera;  ///< of set-ip: serial number, MAC, user-defined name or address
  std::string address;
  std::string mask;  ///< empty = the interface's
  std::string gateway = "0.0.0.0";
  bool persistent = false;
};

/// Adds `devices` and `camera` with its command. chosen: set to the command that the line names.
void add_device_commands(CLI::App& app, DevicesArguments& arguments, const Terminal& terminal,
                         std::function<int()>& chosen);

}  // namespace fvd::ctl
