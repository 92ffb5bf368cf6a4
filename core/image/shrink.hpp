#pragma once

/// Smaller images of 8 bit, for the eye.

#include <cstdint>

#include "core/image/image.hpp"

namespace fvd {

struct ShrunkImage {
  Plane<std::uint8_t> pixels;  ///< each the mean of factor x factor pixels, the eight highest bits of the format
  std::int64_t saturated = 0;  ///< pixels of the whole image at full scale
};

/// factor: 1 to the shorter side. What remains at the right and the lower border is not shown. context: pure.
[[nodiscard]] ShrunkImage shrink(const ImageView& image, int factor);

/// The least factor by which no side of the image is longer than that, as far as one pixel remains.
[[nodiscard]] int shrink_factor(int width, int height, int most_width, int most_height) noexcept;

}  // namespace fvd
