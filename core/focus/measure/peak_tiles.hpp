#pragma once

/// The highest focus curve of a neighbourhood, to find points at which an edge's blur looks like a surface.
///
/// Out of focus, light of a bright edge reaches windows beside it that hold no texture of their own. Their curves then
/// have a peak at a height where there is no surface. This peak is low compared with that of the edge: a point whose
/// curve rises less than 0.07 of the highest curve within about one window is a hole.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/focus/kernels/focus_kernels.hpp"
#include "core/focus/measure/sharpness_code.hpp"

namespace fvd {

/// To be used from the top row downwards, just ahead of the fit, which then finds the rows in a cache. Not thread-safe;
/// one instance per thread.
class PeakTiles {
 public:
  /// Returns the condensed curves of row y, valid until the next call.
  using CurveOfRow = std::function<CurveRow(int y)>;

  /// reach_px: side of a tile; a point is compared with its own tile and the eight about it.
  PeakTiles(int width, int height, int reach_px, bool root_code, CurveOfRow curves);

  [[nodiscard]] int tile_row(int y) const noexcept { return y / reach_px_; }

  /// Writes 0.07 of the neighbourhood's highest amplitude at each pixel of a row of tiles, as shares of full scale,
  /// shape [width].
  /// Reads the curves of that row of tiles and of its neighbours; reuses the tile rows that the previous call read.
  void least_amplitude(int tile_row, float* out);

 private:
  void look_at(int tile_row);
  [[nodiscard]] std::vector<float>& tiles(int tile_row) noexcept {
    return tiles_[static_cast<std::size_t>(tile_row) % tiles_.size()];
  }

  int width_;
  int height_;
  int reach_px_;
  bool root_code_;
  CurveOfRow curves_;
  int columns_;
  int rows_;
  int first_seen_ = 0;  // rows of tiles that are in tiles_
  int last_seen_ = -1;
  std::array<std::vector<float>, 3> tiles_;  // highest amplitude in shares
  std::vector<std::uint32_t> highest_;       // [width] of a row of tiles, in codes
};

}  // namespace fvd
