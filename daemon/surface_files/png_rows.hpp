#pragma once

/// The pictures of a result as maps: grey levels, or the bits of reasons.

#include <filesystem>
#include <memory>

#include "daemon/surface_files/map_rows.hpp"

namespace fvd {

/// Width and height as the file's head tells them: the decoder takes memory for whatever stands there. Throws Error
/// kSurfaceFile.
[[nodiscard]] GridSize png_size(const std::filesystem::path& path);

/// The samples of a PNG of 8 or 16 bit, as they are; of one in colour its brightness (ITU-R BT.601). Decoded here and
/// held in memory, for a PNG has no places that could be read alone. Throws Error kSurfaceFile.
[[nodiscard]] std::shared_ptr<const MapRows> open_png_rows(const std::filesystem::path& path);

}  // namespace fvd
