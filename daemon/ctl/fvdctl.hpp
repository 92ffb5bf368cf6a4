#pragma once

/// The command line of fvdctl.

#include <ostream>
#include <string>
#include <vector>

namespace fvd::ctl {

struct Terminal {
  std::ostream& out;
  std::ostream& err;
  bool out_is_terminal = false;
  bool err_is_terminal = false;
  int in_fd = -1;  ///< where answers come from; -1 = nowhere
};

/// Runs one command; arguments without the program's name. Returns the exit code (exit_codes.hpp); never throws.
[[nodiscard]] int run_fvdctl(const std::vector<std::string>& arguments, const Terminal& terminal) noexcept;

}  // namespace fvd::ctl
