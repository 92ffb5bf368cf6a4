#pragma once

/// From a camera's pixel format to a slice's: packed values spread to 16 bit, upper bits brought down, a mosaic made
/// one value per pixel.

#include <cstddef>
#include <span>

#include "core/image/sensor_format.hpp"

namespace fvd {

/// An image as it came over the wire. Packed formats run on from row to row.
struct WireImage {
  SensorFormat format = SensorFormat::kMono8;
  int significant_bits = 0;  ///< see slice_format()
  BayerUse bayer = BayerUse::kGreen;
  int width = 0;                     ///< > 0; of a mosaic > 1
  int height = 0;                    ///< likewise
  std::span<const std::byte> bytes;  ///< sensor_image_bytes() at least, aligned to 2
};

/// False if the bytes on the wire already are the slice.
[[nodiscard]] bool needs_unpacking(SensorFormat format, int significant_bits);

/// Writes width * height pixels of slice_format(), rows contiguous, aligned to 2. Of a mosaic: green as it is and
/// elsewhere the rounded mean of its four green neighbours, or the rounded mean of the pixel and those right, below,
/// and right below; beyond the border the image is mirrored. Layouts: GenICam Pixel Format Naming Convention 2.4
/// (Mono10p, Mono12p: least significant bits first); Mono12Packed: GigE Vision 2.0, section 26. Throws Error kBadSlice
/// if either side is too short. context: thread-safe.
void unpack(const WireImage& image, std::span<std::byte> slice);

/// The same result as unpack(), one pixel at a time, for tests; throws as it does. context: thread-safe.
void unpack_reference(const WireImage& image, std::span<std::byte> slice);

}  // namespace fvd
