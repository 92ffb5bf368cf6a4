#pragma once

/// What the configuration leads to, beyond its own values.

#include "config/problem.hpp"
#include "daemon/config/config.hpp"

namespace fvd {

/// For --check-config: recipes that are refused, shipped and edited ones, and folders that cannot be made or hold
/// nothing written. Touches no device, makes nothing. What the user who asks may not look at is not judged.
[[nodiscard]] Problems check_station(const Config& config);

}  // namespace fvd
