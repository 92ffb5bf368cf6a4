#pragma once

/// Finds the camera that the configuration names. No Aravis in this header.

#include <optional>
#include <string>

#include "drivers/common/driver_config.hpp"
#include "drivers/gige/found_camera.hpp"

namespace fvd {

/// How the configured camera is opened.
struct CameraTarget {
  std::string name;                     ///< for messages: as configured, with the IP address where that is another
  std::string open_by;                  ///< IP address, or serial number of a USB3 Vision camera
  std::optional<FoundCamera> identity;  ///< of a GigE Vision camera that tells
};

/// Throws Error kBadConfig for an empty address, kCameraDisconnected if no camera, or more than one, is called so, or
/// the one that is has another serial number than config.serial.
[[nodiscard]] CameraTarget find_camera(const CameraConfig& config);

/// Throws Error kCameraDisconnected if `serial` is not config.serial, unless that is empty. what: the camera found.
void require_serial(const CameraConfig& config, const std::string& serial, const std::string& what);

}  // namespace fvd
