#pragma once

/// The result of a scan: heights with honest holes.

#include <cstdint>

#include "core/focus/fit/stage_correction.hpp"
#include "core/image/image.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd {

/// All planes have shape [height][width] of the slices.
struct HeightMap {
  Plane<float> height_m;    ///< metres, NaN exactly where mask != 0
  Plane<MaskReasons> mask;  ///< 0 valid, else mask_reason bits
  Plane<float> sigma_m;     ///< expected standard error of the height, metres; NaN where mask != 0
  Plane<float> prominence;  ///< 0..1
  PixelFormat texture_format = PixelFormat::kMono8;
  Plane<std::uint16_t> texture;  ///< all-in-focus: grey level at the peak slice, 0..max_grey_level(texture_format)
  Plane<std::uint8_t> colour;  ///< shape [height][3 * width]: blue, green, red at the peak slice; empty for grey slices
  StageCorrection stage;       ///< the stage's errors as seen in the curves, and whether heights were corrected by them
  double noise_grey = 0.0;     ///< standard deviation of a pixel in grey levels, median over the image
  /// Full width at half maximum of the focus curve, median over points of the image; 0 = unknown.
  double curve_width_um = 0.0;
};

/// All planes but `colour` allocated and uninitialised; the caller must write every element.
[[nodiscard]] inline HeightMap empty_map(int width, int height, PixelFormat format,
                                         const KeptPagesPtr& pages = nullptr) {
  HeightMap map;
  map.height_m = Plane<float>::unset(width, height, pages);
  map.mask = Plane<MaskReasons>::unset(width, height, pages);
  map.sigma_m = Plane<float>::unset(width, height, pages);
  map.prominence = Plane<float>::unset(width, height, pages);
  map.texture_format = format;
  map.texture = Plane<std::uint16_t>::unset(width, height, pages);
  return map;
}

}  // namespace fvd
