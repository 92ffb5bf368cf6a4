#pragma once

/// Checks that a buffer is the configured image. Inside the driver only: this header includes Aravis.

#include <span>
#include <string>

#include <arv.h>

#include "core/hw/camera.hpp"
#include "core/image/frame.hpp"

namespace fvd {

/// kOk: complete, one image, of the format and size of `settings`, whose width and height are > 0; chunks may follow it
/// and padding its lines. Of an incomplete buffer only the status is read: the rest may be left over from its last use.
/// refusal: set to what came and what was expected, for kWrongGeometry.
[[nodiscard]] FrameStatus check_frame(ArvBuffer* buffer, const CameraSettings& settings, std::string& refusal);

/// The image of a buffer that check_frame found kOk, line after line. Padding is moved behind the image: once per
/// buffer.
[[nodiscard]] std::span<const std::byte> wire_image(ArvBuffer* buffer, const CameraSettings& settings);

}  // namespace fvd
