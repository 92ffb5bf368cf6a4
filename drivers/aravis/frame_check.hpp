#pragma once

/// Checks that a buffer is the configured image. Inside the driver only: this header includes Aravis.

#include <span>

#include <arv.h>

#include "core/hw/camera.hpp"
#include "core/image/frame.hpp"

namespace fvd {

/// kOk: complete, one image, of the format and size of `settings`, whose width and height are > 0. Of an incomplete
/// buffer only the status is read: the rest may be left over from its last use.
[[nodiscard]] FrameStatus check_frame(ArvBuffer* buffer, const CameraSettings& settings);

/// The image of a buffer that check_frame found kOk, as it came over the wire.
[[nodiscard]] std::span<const std::byte> wire_image(ArvBuffer* buffer, const CameraSettings& settings);

}  // namespace fvd
