#pragma once

/// Values of a surface at the size that a picture shows them at.

#include <cstddef>
#include <vector>

#include "core/image/image.hpp"

namespace fvd {

/// Shape [height][width], row 0 on top; NaN = hole.
struct ScalarImage {
  int width = 0;
  int height = 0;
  std::vector<float> values;
  [[nodiscard]] float at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// metres as um, shrunk by the same whole factor both ways until neither side is above `most`: means of the valid
/// points of each block, a hole where under half of them are valid. A block that the border cuts is of what is there.
[[nodiscard]] ScalarImage shrunk_um(const PlaneView<const float>& metres, int most);

/// The columns or rows that become one in shrunk_um(), >= 1.
[[nodiscard]] int shrink_factor(int width, int height, int most) noexcept;

struct ValueRange {
  double low = 0.0;
  double high = 1.0;  ///< > low
  bool any = false;   ///< false: every point is a hole, and the range means nothing
};

/// Between the values that the fraction of the points lies below and above; widened where the values are flat, so that
/// the two always differ.
[[nodiscard]] ValueRange robust_range(const ScalarImage& image, double fraction);

}  // namespace fvd
