#pragma once

/// Where the pixels of an image are.

#include "sim/artefact/plan.hpp"

namespace fvd::sim {

/// Square pixels about the middle of the image.
struct PixelGrid {
  int width_px = 0;
  int height_px = 0;
  double pitch_um = 1.0;

  /// A pixel's centre, um from the image's middle.
  [[nodiscard]] Place centre(int x, int y) const {
    return {(x - 0.5 * (width_px - 1)) * pitch_um, (y - 0.5 * (height_px - 1)) * pitch_um};
  }
  /// The same place, um from the outer corner of pixel (0, 0).
  [[nodiscard]] Place from_corner(const Place& place) const {
    return {place.x_um + 0.5 * width_px * pitch_um, place.y_um + 0.5 * height_px * pitch_um};
  }
  [[nodiscard]] double reach_um() const { return 0.5 * pitch_um * std::hypot(width_px, height_px); }
};

}  // namespace fvd::sim
