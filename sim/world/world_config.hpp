#pragma once

/// Worlds and plants as JSON files.

#include <filesystem>

#include "sim/axis/axis_model.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// File names of a height map and of a contrast picture are relative to the world's file. Throws Error kBadConfig with
/// every problem, kBadInput if the file cannot be read.
[[nodiscard]] WorldParameters load_world(const std::filesystem::path& file);
[[nodiscard]] AxisParameters load_plant(const std::filesystem::path& file);

}  // namespace fvd::sim
