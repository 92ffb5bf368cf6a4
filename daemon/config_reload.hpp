#pragma once

/// What a daemon that runs can take from a configuration that was changed.

#include <string>
#include <vector>

#include "daemon/config/config_file.hpp"

namespace fvd {

struct Reload {
  std::string refusal;               ///< why nothing of it is taken; empty = all of it is
  std::vector<std::string> changes;  ///< "/log/level: info -> debug"; empty = nothing differs
};

/// All or nothing: one problem, or one changed key that only a start can take, refuses the whole of it. Taken while
/// the daemon runs are /log/level and what is kept of results (/store); recipes and the file of tokens are read anew
/// whenever one is asked for.
[[nodiscard]] Reload plan_reload(const Config& running, const LoadedConfig& wanted);

}  // namespace fvd
