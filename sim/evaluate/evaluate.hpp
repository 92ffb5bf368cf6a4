#pragma once

/// Comparison of a result of fvd with the truth of the simulated world.

#include <filesystem>
#include <iosfwd>

#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// Writes truth.gsf (heights in metres), regions.png (labels of surface.hpp) and truth.json (truth_file.hpp) into an
/// existing folder.
/// Throws Error kStorageWrite.
void write_truth(const WorldParameters& world, const std::filesystem::path& folder);

/// Compares the height maps in `result_dir` (result.json, height.tiff, height_<method>.tiff, mask.png) with the world
/// and prints a table; with `with_json` the last line is one JSON object of the figures. RMS errors are of height minus
/// truth over the valid points of the region interiors, nothing removed. Throws Error kBadInput for files that are
/// missing or of another size.
void evaluate(const WorldParameters& world, const std::filesystem::path& result_dir, bool with_json, std::ostream& out);

}  // namespace fvd::sim
