#pragma once

/// USB3 Vision cameras that are plugged in.

#include <vector>

#include "drivers/gige/found_camera.hpp"

namespace fvd {

/// Sends nothing over any network. Empty where there is none, or none that this user may open.
[[nodiscard]] std::vector<FoundCamera> list_usb_cameras();

}  // namespace fvd
