#pragma once

/// How high the focus curves of a neighbourhood rise, to find points that see an edge's blur instead of a surface.
///
/// Out of focus, light of a bright edge reaches windows beside it that hold no texture of their own. Their curves have
/// a peak then, at a height where there is nothing. It is low beside the edge's own: a point whose curve rises less
/// than a tenth of the highest within about a window from it is no surface.

#include <vector>

#include "core/focus/focus_kernels.hpp"
#include "core/focus/sharpness_code.hpp"

namespace fvd {

/// context: add_row() for rows of different tile rows from many threads; least_amplitude() after all of them.
class PeakTiles {
 public:
  /// reach_px: side of a tile; a point is compared with its own tile and the eight about it.
  PeakTiles(int width, int height, int reach_px, bool root_code);

  [[nodiscard]] int rows() const noexcept { return rows_; }
  /// Rows of pixels [first, end) of a row of tiles.
  [[nodiscard]] int first(int tile_row) const noexcept { return tile_row * reach_px_; }
  [[nodiscard]] int end(int tile_row) const noexcept;

  void add_row(int y, const CurveRow& row) noexcept;

  /// A tenth of the neighbourhood's highest amplitude at each pixel of row y, in shares. Shape [width].
  void least_amplitude(int y, float* out) const noexcept;

 private:
  int width_;
  int height_;
  int reach_px_;
  bool root_code_;
  int columns_;
  int rows_;
  std::vector<float> highest_;  // [rows][columns]
};

}  // namespace fvd
