#pragma once

/// What a measurement of a world should find, as JSON.

#include <filesystem>

#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// Writes truth.json into an existing folder: the surface's kind, the image, tilt, polished regions and the dimensions
/// of what lies there, units in the keys; places in um from the outer corner of pixel (0, 0), x right, y down; null
/// where there is no such value. Dimensions are those of the surface itself, nothing is averaged over a focus window.
/// Throws Error kStorageWrite.
void write_truth_file(const WorldParameters& world, const std::filesystem::path& folder);

}  // namespace fvd::sim
