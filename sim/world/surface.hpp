#pragma once

/// The heights of a simulated surface, and its regions.

#include <cstdint>

#include "core/image/image.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

/// Regions for comparing a measurement with the truth. Interiors keep kRegionMargin_px from every step, from the
/// texture-poor patch and from the image's border, so that no window of 9 x 9 mixes two of them.
enum class Region : std::uint8_t {
  kNone = 0,
  kPlateauA = 1,
  kPlateauB = 2,
  kPlateauC = 3,
  kRamp = 4,
  kPoor = 5,
  kSurface = 6
};
inline constexpr int kRegionMargin_px = 12;

struct Surface {
  Plane<float> height_um;      ///< [height][width]
  Plane<float> contrast;       ///< share of the texture's contrast, 0..1
  Plane<std::uint8_t> poor;    ///< 1 where there is hardly any texture, or none
  Plane<std::uint8_t> region;  ///< Region of each pixel
};

/// Throws Error kBadConfig for a size the surface cannot have, kBadInput for an unreadable height map.
[[nodiscard]] Surface make_surface(const WorldParameters& world);

}  // namespace fvd::sim
