#pragma once

/// How much of the disk a job's result takes, from its recipe alone: known before anything moves.

#include <cstdint>

#include "daemon/recipes/recipe.hpp"

namespace fvd {

/// Bytes, rather too many: maps that compress well count in full. width, height: of the slices, > 0.
[[nodiscard]] std::uint64_t job_storage_bytes(const Recipe& recipe, int width, int height);

}  // namespace fvd
