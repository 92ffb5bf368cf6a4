#pragma once

/// Height maps in Gwyddion Simple Field 1.0 (gwyddion.net/documentation/user-guide-en/gsf.html).

#include <filesystem>

#include "core/image/image.hpp"

namespace fvd::sim {

/// Heights in um; the file's are in metres. Holes (NaN) are refused: a surface has a height everywhere.
/// Throws Error kBadInput naming the file and what is wrong with it.
[[nodiscard]] Plane<float> read_gsf_um(const std::filesystem::path& file);

}  // namespace fvd::sim
