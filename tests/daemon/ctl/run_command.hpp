#pragma once

/// Runs fvdctl in this process, for tests.

#include <sstream>
#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"

namespace fvd::test {

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

/// terminal: as if it wrote to one.
inline Outcome run_command(const std::vector<std::string>& arguments, bool terminal = false) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = ctl::run_fvdctl(arguments, {out, err, terminal, terminal});
  return {code, out.str(), err.str()};
}

inline Outcome process(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "process");
  return run_command(arguments);
}

}  // namespace fvd::test
