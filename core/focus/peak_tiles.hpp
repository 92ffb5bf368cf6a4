#pragma once

/// How high the focus curves of a neighbourhood rise, to find points that see an edge's blur instead of a surface.
///
/// Out of focus, light of a bright edge reaches windows beside it that hold no texture of their own. Their curves have
/// a peak then, at a height where there is nothing. It is low beside the edge's own: a point whose curve rises less
/// than a tenth of the highest within about a window from it is no surface.

#include <cstdint>
#include <vector>

#include "core/focus/focus_kernels.hpp"
#include "core/focus/sharpness_code.hpp"

namespace fvd {

/// context: set_row() for different tile rows from many threads; spread() after all of them; then least_amplitude()
/// from many threads.
class PeakTiles {
 public:
  /// reach_px: side of a tile; a point is compared with its own tile and the eight about it.
  PeakTiles(int width, int height, int reach_px, bool root_code);

  [[nodiscard]] int rows() const noexcept { return rows_; }
  /// Rows of pixels [first, end) of a row of tiles.
  [[nodiscard]] int first(int tile_row) const noexcept { return tile_row * reach_px_; }
  [[nodiscard]] int end(int tile_row) const noexcept;
  [[nodiscard]] int tile_row(int y) const noexcept { return y / reach_px_; }

  /// highest: amplitude of codes in each column of pixels, see FocusKernels::raise_amplitudes. Shape [width].
  void set_row(int tile_row, const std::uint32_t* highest) noexcept;

  /// Makes of each tile's highest amplitude a tenth of its neighbourhood's.
  void spread();

  /// A tenth of the neighbourhood's highest amplitude at each pixel of a row of tiles, in shares. Shape [width].
  void least_amplitude(int tile_row, float* out) const noexcept;

 private:
  int width_;
  int height_;
  int reach_px_;
  float unit_;  // a code's amplitude times this is a share
  int columns_;
  int rows_;
  std::vector<float> values_;  // [rows][columns]: highest amplitude; after spread() the least that counts
};

}  // namespace fvd
