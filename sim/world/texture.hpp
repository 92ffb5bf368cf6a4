#pragma once

/// Textures: granite-like with grains of several sizes, fine-grained, white.

#include <cstdint>

#include "core/image/image.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// 8-bit grey levels with mean 128 and standard deviation `contrast` times `share`, clipped at four standard
/// deviations; periodic at the borders, so that its blur in the frequency domain is exact. The same seed gives the same
/// texture.
[[nodiscard]] Plane<float> make_texture(TextureKind kind, const Plane<float>& share, double contrast,
                                        std::uint64_t seed);

/// The same with the share poor_contrast where poor != 0, else 1.
[[nodiscard]] Plane<float> make_texture(TextureKind kind, const Plane<std::uint8_t>& poor, double contrast,
                                        double poor_contrast, std::uint64_t seed);

}  // namespace fvd::sim
