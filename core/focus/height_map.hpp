#pragma once

/// The result of a scan: heights with honest holes.

#include <cstdint>

#include "core/focus/stage_correction.hpp"
#include "core/image.hpp"

namespace fvd {

/// Why a point is a hole; reasons add up. 0 = valid.
namespace mask_reason {
inline constexpr std::uint8_t kLowProminence = 1U << 0U;  ///< no texture: the focus curve has no peak worth the name
inline constexpr std::uint8_t kFirstSlice =
    1U << 1U;  ///< sharpest at the first slice: the surface may lie below the range
inline constexpr std::uint8_t kLastSlice = 1U << 2U;      ///< sharpest at the last slice: it may lie above
inline constexpr std::uint8_t kNotBracketed = 1U << 3U;   ///< the neighbours do not enclose a maximum
inline constexpr std::uint8_t kSaturated = 1U << 4U;      ///< a pixel at full scale inside the window at the peak
inline constexpr std::uint8_t kInsignificant = 1U << 5U;  ///< the peak stands too little above the noise
inline constexpr std::uint8_t kEdgeBleeding = 1U << 6U;   ///< the blur of a far brighter edge next to it, no surface
}  // namespace mask_reason

/// All planes have shape [height][width] of the slices.
struct HeightMap {
  Plane<float> height_m;     ///< metres, NaN exactly where mask != 0
  Plane<std::uint8_t> mask;  ///< 0 valid, else mask_reason bits
  Plane<float> sigma_m;      ///< expected standard error of the height, metres; NaN where mask != 0
  Plane<float> prominence;   ///< 0..1
  PixelFormat texture_format = PixelFormat::kMono8;
  Plane<std::uint16_t> texture;  ///< all-in-focus: grey level at the peak slice, 0..max_grey_level(texture_format)
  Plane<std::uint8_t> colour;  ///< shape [height][3 * width]: blue, green, red at the peak slice; empty for grey slices
  StageCorrection stage;       ///< what the scan says about the stage, and whether heights were corrected by it
  double noise_grey = 0.0;     ///< standard deviation of a pixel in grey levels, median over the image
  double curve_width_um =
      0.0;  ///< full width at half maximum of the focus curve, median of points over the image; 0 unknown
};

/// All planes allocated, contents to be written.
[[nodiscard]] inline HeightMap empty_map(int width, int height, PixelFormat format) {
  HeightMap map;
  map.height_m = Plane<float>::unset(width, height);
  map.mask = Plane<std::uint8_t>::unset(width, height);
  map.sigma_m = Plane<float>::unset(width, height);
  map.prominence = Plane<float>::unset(width, height);
  map.texture_format = format;
  map.texture = Plane<std::uint16_t>::unset(width, height);
  return map;
}

}  // namespace fvd
