#pragma once

/// A camera's image as a PNG file.

#include <string>

#include "core/image/image.hpp"

namespace fvd {

/// 8 bit for Mono8, else 16 bit with the grey levels unchanged. Throws Error kInternal.
[[nodiscard]] std::string encode_image_png(const ImageView& image);

}  // namespace fvd
