#pragma once

/// The option --pitch-um of commands that read surfaces.

#include <vector>

#include "daemon/surface_files/surface_files.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

void add_pitch_option(CLI::App& command, std::vector<double>& pitch_um);

/// pitch_um: of columns and rows, or one of both; empty = as the source tells. Throws UsageError for more.
[[nodiscard]] SurfaceReadOptions read_options(const std::vector<double>& pitch_um);

}  // namespace fvd::ctl
