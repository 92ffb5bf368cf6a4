#pragma once

/// A GigE Vision or USB3 Vision camera through Aravis.

#include <chrono>
#include <memory>

#include "core/hw/camera.hpp"
#include "drivers/aravis/camera_search.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// Opens the camera and takes control of it. Throws Error kCameraDisconnected if it does not answer or another program
/// controls it, kCameraSettings if it refuses the packet size.
/// clock_renewal: age at which the offset of the camera's clock is measured again; tests make it short.
[[nodiscard]] std::unique_ptr<Camera> open_aravis_camera(
    const CameraConfig& config, std::chrono::milliseconds clock_renewal = std::chrono::seconds(5));

/// Opens the camera that find_camera() found. Throws as above, and kCameraDisconnected if the camera that was opened
/// has another serial number than the one found, or than config.serial.
[[nodiscard]] std::unique_ptr<Camera> open_aravis_camera(
    const CameraConfig& config, const CameraTarget& found,
    std::chrono::milliseconds clock_renewal = std::chrono::seconds(5));

}  // namespace fvd
