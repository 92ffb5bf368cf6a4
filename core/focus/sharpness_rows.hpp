#pragma once

/// The sum-modified-Laplacian row by row: what a band of the image needs, in memory that does not grow with it.
///
///   F(x,y) = sum of ML over the n x n window about (x,y), clipped at the image's border
///
/// 16 bit, n = 63: <= 3969 * 262140 = 1.04e9, fits uint32. Running column and row sums make the cost independent of n.

#include <cstdint>
#include <vector>

#include "core/focus/modified_laplacian.hpp"
#include "core/image.hpp"

namespace fvd {

/// Pixel: std::uint8_t or std::uint16_t. All memory is taken by the constructor.
/// context: one thread; one scanner a thread.
template <typename Pixel>
class SharpnessRows {
 public:
  /// width >= 1; window odd, 3..63; distance of the Laplacian's neighbours >= 1.
  SharpnessRows(int width, int window, int distance);

  /// Starts at row `first` of an image of the constructor's width. A pixel >= saturation counts as saturated.
  void begin(PlaneView<const Pixel> image, int first, int saturation) noexcept;

  /// Computes the next row: sharpness() and saturated() then hold it. Not called past the last row.
  void next() noexcept;

  /// Shape [width].
  [[nodiscard]] const std::uint32_t* sharpness() const noexcept { return sums_.data(); }
  /// Shape [width], 1 where a pixel inside the window is saturated, else 0.
  [[nodiscard]] const std::uint8_t* saturated() const noexcept { return saturated_.data(); }

  [[nodiscard]] static std::size_t memory_bytes(int width, int window);

 private:
  using Laplacian = LaplacianOf<Pixel>;

  void enter(int y) noexcept;
  void leave(int y) noexcept;
  void sum_columns() noexcept;
  void find_saturated() noexcept;
  [[nodiscard]] Laplacian* ring_row(int y) noexcept;
  [[nodiscard]] bool row_saturated(int y) const noexcept;

  int width_;
  int window_;
  int radius_;
  int distance_;
  PlaneView<const Pixel> image_;
  int saturation_ = 0;
  int y_ = 0;
  int saturated_rows_ = 0;              // rows inside the window that hold a saturated pixel
  std::vector<Laplacian> ring_;         // [window][width], ML of the rows inside the window
  std::vector<std::uint32_t> columns_;  // [width], sum over the window's rows
  std::vector<std::uint32_t> sums_;
  std::vector<std::uint8_t> saturated_columns_;  // [width], saturated pixels in the window's rows, <= 63
  std::vector<std::uint8_t> saturated_;
};

/// The same for a whole image, obviously correct: every window summed anew. Shape of the image.
[[nodiscard]] Plane<std::uint32_t> sharpness_reference(const ImageView& image, int window, int distance);

extern template class SharpnessRows<std::uint8_t>;
extern template class SharpnessRows<std::uint16_t>;

}  // namespace fvd
