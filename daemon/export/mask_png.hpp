#pragma once

/// Why points of a height map are holes, as an image.

#include <string>

#include "core/focus/fit/height_map.hpp"

namespace fvd {

struct ExportInput;

/// 16 bit: 0 = valid, else the mask_reason bits. Throws Error kInternal.
[[nodiscard]] std::string encode_mask_png(const HeightMap& map);

/// The exporter: encode_mask_png() of the input's map.
[[nodiscard]] std::string mask_png_file(const ExportInput& input);

}  // namespace fvd
