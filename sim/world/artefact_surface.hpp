#pragma once

/// The heights of a virtual artefact on the sensor's pixels, and the level that each pixel lies on.

#include <cstdint>

#include "core/image/image.hpp"
#include "sim/artefact/parameter_check.hpp"
#include "sim/world/pixel_grid.hpp"
#include "sim/world/world_parameters.hpp"

namespace fvd::sim {

struct ArtefactSurface {
  Plane<float> height_um;     ///< [height][width], at the pixels' centres
  Plane<std::uint8_t> level;  ///< as in stepped_artefacts.hpp; 0 where there are no levels
};

[[nodiscard]] inline PixelGrid grid_of(const WorldParameters& world) {
  return {world.width_px, world.height_px, world.pixel_pitch_um};
}

/// Dimensions of the world's artefact and of its contrast map that do not go together.
[[nodiscard]] std::vector<BadParameter> bad_parameters(const WorldParameters& world);

/// Of an artefact (is_artefact). Throws Error kBadConfig with every one of bad_parameters.
[[nodiscard]] ArtefactSurface make_artefact(const WorldParameters& world);

/// Height of the tilted plane over the middle of the image.
[[nodiscard]] inline double plane_um(const Tilt& tilt, const Place& place) {
  return tilt.slope_x * place.x_um + tilt.slope_y * place.y_um;
}

}  // namespace fvd::sim
