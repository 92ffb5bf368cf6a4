#pragma once

/// The drivers by name: the only place that knows them all.

#include <memory>

#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// Opens the camera. Throws Error kBadConfig for an unknown driver (the message lists the known ones), else what the
/// driver throws.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const CameraConfig& config);

/// Connects the stage. Throws likewise.
[[nodiscard]] std::unique_ptr<Axis> open_stage(const StageConfig& config);

}  // namespace fvd
