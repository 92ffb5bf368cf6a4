#pragma once

/// From a grey image to what a camera of a given pixel format sends.

#include <cstddef>
#include <span>

#include "core/image/sensor_format.hpp"

namespace fvd::sim {

/// True where the rendered image is not what goes over the wire.
[[nodiscard]] bool needs_readout(SensorFormat format);

/// pixels: width * height of slice_format(format, 0), rows contiguous. wire: sensor_image_bytes(format, width, height).
/// offset_x, offset_y: of the region on the sensor, which the colours of a Bayer mosaic belong to. Red is 0.8 and blue
/// 0.6 times the grey value.
void read_out(SensorFormat format, std::span<const std::byte> pixels, int width, int offset_x, int offset_y,
              std::span<std::byte> wire);

}  // namespace fvd::sim
