#pragma once

/// Textures: granite-like with grains of several sizes, fine-grained, white.

#include <cstdint>

#include "core/image/image.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// 8-bit grey levels with mean 128 and standard deviation `contrast`, clipped at four standard deviations; periodic at
/// the borders, so that its blur in the frequency domain is exact. The contrast is multiplied by poor_contrast where
/// poor != 0. The same seed gives the same texture.
[[nodiscard]] Plane<float> make_texture(TextureKind kind, const Plane<std::uint8_t>& poor, double contrast,
                                        double poor_contrast, std::uint64_t seed);

}  // namespace fvd::sim
