#pragma once

/// The focus measure row by row, in memory that does not grow with the image's height.
///
///   F(x,y) = sum of the operator's values over the window about (x,y)
///
/// Outside the image the edge pixel is repeated. Near the image's border the window shrinks on both sides alike, to
/// half its size at the least, so that it stays centred: the centre of a clipped window would lie beside the pixel,
/// which tilts every slope there. The part of the half window that still reaches beyond the border is clipped.
///
/// Operators, with neighbours at distance d:
///   modified Laplacian (Nayar and Nakagawa, IEEE PAMI 16(8), 1994): |2 I - I(x-d) - I(x+d)| + |2 I - I(y-d) - I(y+d)|;
///     the absolute values are summed so that curvatures of opposite sign do not cancel
///   Tenengrad (Tenenbaum, Stanford, 1970): gx^2 + gy^2 of the 3 x 3 Sobel operator, its rows and columns d apart
///   intensity: I
///
/// Running column sums and sums in powers of three make the cost nearly independent of the window.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/focus/kernels/focus_kernels.hpp"
#include "core/focus/measure/sharpness_code.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// The rows, or columns, of the window about `centre`: first and last.
struct WindowReach {
  WindowReach(int centre, int radius, int size) noexcept {
    const int reach = std::max(std::min({radius, centre, size - 1 - centre}), (radius + 1) / 2);
    first = std::max(0, centre - reach);
    last = std::min(size - 1, centre + reach);
  }
  int first;
  int last;
};

/// Pixel: std::uint8_t or std::uint16_t. The constructor allocates all memory.
/// Not thread-safe; one instance per thread and slice.
template <typename Pixel>
class SharpnessRows {
 public:
  /// width >= 1; settings checked; format of the Pixel's size.
  SharpnessRows(int width, const FocusSettings& settings, PixelFormat format);

  /// Starts at row `first` of an image of the constructor's width and format.
  void begin(PlaneView<const Pixel> image, int first) noexcept;

  /// Computes the next row: codes() and saturated() then hold it. Not called past the last row.
  void next() noexcept;

  /// Shape [width]; see sharpness_code.hpp.
  [[nodiscard]] const std::uint16_t* codes() const noexcept { return codes_.data(); }
  /// Shape [width], 1 where a pixel inside the window is saturated, else 0.
  [[nodiscard]] const std::uint8_t* saturated() const noexcept { return saturated_.data(); }

  [[nodiscard]] static std::size_t memory_bytes(int width, int window);

 private:
  /// The sums of one width of integer: 16 bit for the 8-bit modified Laplacian, 32 bit for all else.
  template <typename Sum>
  struct Columns {
    std::vector<Sum> ring;     // [window][width], values of the rows inside the window, 0 where there is none
    std::vector<Sum> fresh;    // [width], the row that enters
    std::vector<Sum> sums;     // [width], over the window's rows
    std::vector<Sum> scaled;   // [width], what is summed along the row
    std::vector<Sum> windows;  // [width]
  };
  using Narrow = Columns<std::uint16_t>;
  using Wide = Columns<std::uint32_t>;

  template <typename Sum>
  void resize(Columns<Sum>& columns);
  template <typename Sum>
  void clear(Columns<Sum>& columns) noexcept;
  void enter(Narrow& columns, int y) noexcept;
  void enter(Wide& columns, int y) noexcept;
  void leave(Narrow& columns, int y) noexcept;
  void leave(Wide& columns, int y) noexcept;
  void enter(int y) noexcept;
  void leave(int y) noexcept;
  void prefetch_row(int y) const noexcept;
  void compute_row(int y, std::uint32_t* out) noexcept;
  template <typename At>
  void for_ends(At at) noexcept;
  void emit_narrow() noexcept;
  void emit_wide() noexcept;
  [[nodiscard]] bool row_saturated(int y) const noexcept;
  void count_saturated(int y, int change) noexcept;
  void find_saturated() noexcept;

  const FocusKernels& kernels_;
  int width_;
  int window_;
  int radius_;
  int distance_;
  FocusOperator operator_;
  SharpnessCode code_;
  int saturation_;
  bool narrow_;
  PlaneView<const Pixel> image_;
  int y_ = 0;    // next row to emit
  int low_ = 0;  // rows [low_, high_) are inside the window
  int high_ = 0;
  int saturated_rows_ = 0;  // rows inside the window that hold a saturated pixel
  Narrow narrow_columns_;
  Wide wide_columns_;
  std::vector<std::uint16_t> codes_;
  std::vector<std::uint16_t> saturated_columns_;  // [width], saturated pixels in the window's rows, <= 63
  std::vector<std::uint16_t> saturated_counts_;   // [width], over the window
  std::vector<std::uint8_t> saturated_;
  bool saturated_clear_ = true;
};

/// The same codes for a whole image, obviously correct: every window is summed anew. Shape of the image. For tests.
[[nodiscard]] Plane<std::uint16_t> sharpness_reference(const ImageView& image, const FocusSettings& settings);

extern template class SharpnessRows<std::uint8_t>;
extern template class SharpnessRows<std::uint16_t>;

}  // namespace fvd
