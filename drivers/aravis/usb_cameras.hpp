#pragma once

/// USB3 Vision cameras that are plugged in, as the system lists them.

#include <filesystem>
#include <optional>
#include <vector>

#include "drivers/gige/found_camera.hpp"

namespace fvd {

/// Whether this process may open them or not. Opens and sends nothing. Nothing if the system has no USB bus. sysfs,
/// dev: where the system lists devices; tests pass other folders.
[[nodiscard]] std::optional<std::vector<FoundCamera>> list_usb_cameras(
    const std::filesystem::path& sysfs = "/sys/bus/usb/devices", const std::filesystem::path& dev = "/dev/bus/usb");

}  // namespace fvd
