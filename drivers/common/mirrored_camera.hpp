#pragma once

/// A camera whose pictures come the wrong way round: it delivers them upright, whatever the driver behind it.

#include <memory>

#include "core/hw/camera.hpp"
#include "core/image/mirror.hpp"

namespace fvd {

/// The camera itself if the mirror does nothing. Frames are turned in the camera's own slots, without a copy. Regions
/// of settings are those of the upright picture: offset 0 is its left and its top. Throws as the camera does.
[[nodiscard]] std::unique_ptr<Camera> upright(std::unique_ptr<Camera> camera, const Mirror& mirror);

}  // namespace fvd
