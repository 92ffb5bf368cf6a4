#pragma once

/// Converts a grey image to the bytes that a camera of a given pixel format sends.

#include <cstddef>
#include <span>

#include "core/image/sensor_format.hpp"

namespace fvd::sim {

/// True where the rendered image is not what goes over the wire.
[[nodiscard]] bool needs_readout(SensorFormat format);

/// pixels: width * height of slice_format(format, 0), rows contiguous. wire: sensor_image_bytes(format, width, height).
/// offset_x, offset_y: position of the region on the sensor, on which the Bayer mosaic is fixed. Red pixels have 0.8
/// and blue ones 0.6 times the grey value.
void read_out(SensorFormat format, std::span<const std::byte> pixels, int width, int offset_x, int offset_y,
              std::span<std::byte> wire);

}  // namespace fvd::sim
