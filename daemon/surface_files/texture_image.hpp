#pragma once

/// Reading back the all-in-focus image of a result.

#include <cstdint>
#include <filesystem>

#include "core/image/image.hpp"
#include "core/surface/surface.hpp"
#include "daemon/result/result.hpp"

namespace fvd {

/// One of the planes, or none.
struct TextureImage {
  Plane<std::uint16_t> grey;
  Plane<std::uint8_t> colour;  ///< [height][3 * width]: blue, green, red
  PixelFormat format = PixelFormat::kMono8;
};

/// From texture.png in the folder; none where that is not there, or not of the surface's size. Where the result does
/// not tell the format of the levels, it is the narrowest that holds them. Throws Error kSurfaceFile. context:
/// thread-safe.
[[nodiscard]] TextureImage read_texture(const std::filesystem::path& folder, const Surface& surface,
                                        const Result& result);

}  // namespace fvd
