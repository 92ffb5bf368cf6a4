#pragma once

/// Brightness of an image, and the exposure that would correct it.

#include "core/image/image.hpp"

namespace fvd {

/// Grey levels, 0..max_grey_level of the image's format.
struct GreyStatistics {
  int min = 0;
  int max = 0;
  double mean = 0.0;
  int p01 = 0;  ///< 1 % of the pixels are darker
  int p50 = 0;
  int p99 = 0;
  int p999 = 0;                     ///< 0.1 % of the pixels are brighter
  double saturated_fraction = 0.0;  ///< share of the pixels at full scale, 0..1
};

/// image: at least one pixel. context: pure, as the next.
[[nodiscard]] GreyStatistics grey_statistics(const ImageView& image);

/// Factor on the exposure that brings p999 to `target` of full scale, 0 < target < 1; at most 8. It is 1/4 if more than
/// 0.1 % of the pixels are saturated, because the true factor cannot be computed then.
[[nodiscard]] double exposure_factor(const GreyStatistics& grey, PixelFormat format, double target);

}  // namespace fvd
