#pragma once

/// The noise of the image, estimated in the same scan: every part of it is out of focus in some slice, and the
/// variation from pixel to pixel is noise there.
///
/// J. Immerkaer, "Fast noise variance estimation", CVIU 64(2), 1996: the mask [1 -2 1; -2 4 -2; 1 -2 1] does not see
/// smooth images; of white noise it makes sigma = sqrt(pi / 2) / 6 * mean |response|. Here the mean is taken over tiles
/// of about 128 x 128 pixels, every sixteenth row of each, and each tile keeps its third smallest mean of all slices:
/// two slices that are darker than the others do not make the noise of all seem small.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/focus/kernels/focus_kernels.hpp"
#include "core/image/image.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd {

/// context: one thread at a time; add() spreads its work over the pool. The constructor allocates all memory.
class NoiseProbe {
 public:
  NoiseProbe(int width, int height);

  /// Takes in one slice of the constructor's size.
  void add(const ImageView& slice, WorkerPool& pool) noexcept;

  /// The row of tiles that image row y lies in.
  [[nodiscard]] int tile_row(int y) const noexcept;

  /// Standard deviation in grey levels at each pixel of a row of tiles, at least that of rounding, 1 / sqrt(12).
  /// Shape [width].
  void noise_row(int tile_row, float* out) const noexcept;

  /// Median and minimum over the tiles, in grey levels.
  [[nodiscard]] double median() const;
  [[nodiscard]] double least() const;

 private:
  [[nodiscard]] std::size_t tile_index(int column, int tile_row) const noexcept {
    return static_cast<std::size_t>(tile_row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  template <typename Pixel>
  void add_tiles(PlaneView<const Pixel> slice, int tile_row) noexcept;
  [[nodiscard]] int tile_left(int column) const noexcept;  // with the neighbours that the mask needs
  [[nodiscard]] int tile_right(int column) const noexcept;
  [[nodiscard]] int rank() const noexcept;  // of the mean that counts, 0 = the smallest
  /// Expected value of the mean that counts over that of all.
  [[nodiscard]] double bias() const noexcept;
  [[nodiscard]] float sigma(int column, int tile_row) const noexcept;
  [[nodiscard]] std::vector<float> sigmas() const;

  const FocusKernels& kernels_;
  int width_;
  int height_;
  int columns_;  // of tiles
  int rows_;
  int slices_ = 0;
  std::vector<std::array<double, 3>> least_;  // [rows][columns], mean |response|, the three smallest in order
  std::vector<std::uint64_t> sums_;           // [rows][columns], of the present slice
};

}  // namespace fvd
