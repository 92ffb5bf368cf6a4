#pragma once

/// What one cheap pass over a part of a slice's rows tells: enough to judge it by its neighbours.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/image.hpp"

namespace fvd {

/// How an image is cut into tiles: at most 12 x 12, at least 24 pixels wide and high.
struct TileGrid {
  TileGrid(int width, int height) noexcept;
  [[nodiscard]] int tiles() const noexcept { return columns * rows; }
  /// Too small an image says nothing: it is believed.
  [[nodiscard]] bool judged() const noexcept { return columns >= 4 && rows >= 4; }
  [[nodiscard]] int left(int column) const noexcept { return width * column / columns; }
  [[nodiscard]] int top(int row) const noexcept { return height * row / rows; }

  int width;
  int height;
  int columns;
  int rows;
};

/// Directions along which a second difference over two pixels to either side is taken.
inline constexpr int kDirections = 4;  // along the row, along the column, both diagonals

struct SliceFigures {
  int columns = 0;  ///< of tiles
  int rows = 0;
  double full_scale = 255.0;
  std::vector<double> means;                              ///< grey level, [rows][columns], of every second row
  std::vector<std::array<double, kDirections>> energies;  ///< mean squared second difference, [rows][columns]
  int samples_per_tile = 0;
  std::vector<std::uint16_t> samples;  ///< [rows][columns][samples_per_tile], always of the same pixels

  [[nodiscard]] int tiles() const noexcept { return columns * rows; }
  [[nodiscard]] const std::uint16_t* tile_samples(int tile) const noexcept {
    return samples.data() + static_cast<std::ptrdiff_t>(tile) * samples_per_tile;
  }
  /// Mean squared second difference over all directions.
  [[nodiscard]] double sharpness(int tile) const noexcept;
  [[nodiscard]] double brightness() const noexcept;  ///< mean over the tiles, grey levels
};

/// Reads every second row once and about 70 rows more closely. Empty figures for an image that the grid does not judge.
[[nodiscard]] SliceFigures slice_figures(const ImageView& slice);

/// Every pixel has the same grey level.
[[nodiscard]] bool is_constant(const ImageView& slice) noexcept;

/// Of the same shape and identical to the bit.
[[nodiscard]] bool is_identical(const ImageView& a, const ImageView& b) noexcept;

/// Of every pixel; equal for identical images, and practically never else.
[[nodiscard]] std::uint64_t content_hash(const ImageView& slice) noexcept;

}  // namespace fvd
