#pragma once

/// A grey picture as a JPEG file.

#include <cstdint>
#include <string>

#include "core/image/image.hpp"

namespace fvd {

/// Baseline JPEG in grey. pixels: 1 to 65500 a side. quality: 1 to 100. Throws Error kInternal. context: pure.
[[nodiscard]] std::string encode_grey_jpeg(PlaneView<const std::uint8_t> pixels, int quality);

}  // namespace fvd
