#pragma once

/// What the grey levels of an image say of its exposure.

#include "core/image/image.hpp"

namespace fvd {

struct GreyStatistics {
  int min = 0;
  int max = 0;
  double mean = 0.0;
  int p01 = 0;  ///< 1 % of the pixels are darker
  int p50 = 0;
  int p99 = 0;
  int p999 = 0;  ///< 0.1 % of the pixels are brighter
  double saturated_fraction = 0.0;
};

/// image: at least one pixel.
[[nodiscard]] GreyStatistics grey_statistics(const ImageView& image);

/// Factor on the exposure that brings p999 to `target` of full scale, 0 < target < 1; a quarter where more than 0.1 %
/// is saturated and the true factor cannot be seen, eight at most.
[[nodiscard]] double exposure_factor(const GreyStatistics& grey, PixelFormat format, double target);

}  // namespace fvd
