#pragma once

/// The all-in-focus image of a height map.

#include <string>

#include "core/focus/fit/height_map.hpp"

namespace fvd {

struct ExportInput;

/// 8 bit for Mono8, else 16 bit with the camera's grey levels unchanged; 8 bit in colour for coloured slices. Throws
/// Error kInternal.
[[nodiscard]] std::string encode_texture_png(const HeightMap& map);

/// The exporter: encode_texture_png() of the input's map.
[[nodiscard]] std::string texture_png_file(const ExportInput& input);

}  // namespace fvd
