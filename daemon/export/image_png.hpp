#pragma once

/// Images, and mask and texture of a height map, as PNG files.

#include <string>

#include "core/focus/fit/height_map.hpp"

namespace fvd {

/// 8 bit: 255 = valid, else the mask_reason bits. Throws Error kInternal.
[[nodiscard]] std::string encode_mask_png(const HeightMap& map);

/// The all-in-focus image: 8 bit for Mono8, else 16 bit with the camera's grey levels unchanged. Throws Error
/// kInternal.
[[nodiscard]] std::string encode_texture_png(const HeightMap& map);

/// A camera's image: 8 bit for Mono8, else 16 bit with the grey levels unchanged. Throws Error kInternal.
[[nodiscard]] std::string encode_image_png(const ImageView& image);

}  // namespace fvd
