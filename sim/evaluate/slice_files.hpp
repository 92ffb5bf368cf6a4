#pragma once

/// Slices of a simulated world as a recorded stack.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

struct SliceFileOptions {
  std::optional<double> start_um{};  ///< default: 50 um below the lowest point, down to a whole step
  double step_um = 10.0;             ///< not 0; negative: from above
  std::optional<int> slices{};       ///< 2..10000; default: until 50 um beyond the other end
  std::string format = "png";        ///< one of slice_formats()
};

[[nodiscard]] const std::vector<std::string>& slice_formats();

/// Writes slice_0000.png ... (Mono8), z.txt (um, one number a line) and the folder truth (see write_truth()) into
/// `folder`, which is made if it is missing. Returns the z of each slice.
/// Throws Error kBadInput for a folder that holds something already and for options that give no stack, kStorageWrite,
/// and what make_surface throws; nothing is written before the options are known to be good.
std::vector<double> write_slices(const WorldParameters& world, const std::filesystem::path& folder,
                                 const SliceFileOptions& options);

}  // namespace fvd::sim
