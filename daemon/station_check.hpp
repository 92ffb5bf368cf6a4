#pragma once

/// What the configuration leads to, beyond its own values.

#include "config/problem.hpp"
#include "daemon/config/config.hpp"

namespace fvd {

struct StationCheck {
  Problems problems;
  Problems warnings;  ///< a start takes it as it is, but perhaps it is not what was meant
};

/// For --check-config: recipes that are refused, shipped and edited ones, folders that cannot be made or hold nothing
/// written; with warnings, what is not on this machine and may come later, and addresses that are everybody's. Touches
/// no device, makes nothing. What the user who asks may not look at is not judged.
[[nodiscard]] StationCheck check_station(const Config& config);

}  // namespace fvd
