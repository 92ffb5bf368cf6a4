#pragma once

/// Where the texture of a surface has its whole contrast, and where it is polished.

#include "core/image/image.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// A pixel with a smaller share of the contrast counts as poor in texture.
inline constexpr float kPoorShare = 0.1F;

/// Share of the texture's contrast at every pixel, 0..1, for a surface of this size. Throws Error kBadInput for a
/// picture that cannot be read, has colours or more than 8 bits, or is of another size.
[[nodiscard]] Plane<float> make_contrast(const WorldParameters& world, int width, int height);

}  // namespace fvd::sim
