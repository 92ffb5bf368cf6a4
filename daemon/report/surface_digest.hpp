#pragma once

/// What tells one surface from every other.

#include <string>

#include "core/image/image.hpp"

namespace fvd {

/// SHA-256 (FIPS 180-4), 64 lower-case digits, of the heights as little-endian float32 metres, row after row without
/// padding, every hole as the bytes 00 00 C0 7F.
[[nodiscard]] std::string surface_sha256(const PlaneView<const float>& height_m);

}  // namespace fvd
