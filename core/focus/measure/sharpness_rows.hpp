#pragma once

/// The focus measure row by row, in memory that does not grow with the image's height.
///
///   F(x,y) = sum of the operator's values over the window about (x,y), weighted
///
/// A window is one box, or two laid over each other (see WindowSides), whose weights fall towards the rim: the spatial
/// frequencies that a box turns over in sign hardly pass.
///
/// Outside the image the edge pixel is repeated. Near the image's border the window shrinks on both sides alike, to
/// half its size at the least, so that it stays centred: the centre of a clipped window would lie beside the pixel,
/// which tilts every slope there. The part of the half window that still reaches beyond the border is clipped.
///
/// Operators, with neighbours at distance d:
///   modified Laplacian (Nayar and Nakagawa, IEEE PAMI 16(8), 1994): |2 I - I(x-d) - I(x+d)| + |2 I - I(y-d) - I(y+d)|;
///     the absolute values are summed so that curvatures of opposite sign do not cancel
///   diagonal Laplacian: twice the modified Laplacian, and the absolute second differences along both diagonals at d
///   and
///     at half of d, at least 1 (the extension to the diagonals: Thelen, Frey, Hirsch, Hering, IEEE T-IP 18(1), 2009;
///     the weights: core/focus/README.md). All in one integer; only its size against others of the same operator counts
///   Tenengrad (Tenenbaum, Stanford, 1970): gx^2 + gy^2 of the 3 x 3 Sobel operator, its rows and columns d apart
///   intensity: I
///
/// Running column sums and sums in powers of three make the cost nearly independent of the window.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/base/large_array.hpp"
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

/// From the number of clipped pixels in a window to its level, see clipping.
class ClippedLevels {
 public:
  explicit ClippedLevels(const FocusSettings& settings) noexcept
      : area_(settings.window_px * settings.window_px),
        most_(static_cast<int>(settings.tests.clipped_share * area_)),
        looked_for_(settings.tests.clipped_share > 0.0) {}
  /// Whether anybody asks.
  [[nodiscard]] bool looked_for() const noexcept { return looked_for_; }
  [[nodiscard]] std::uint8_t of(int pixels) const noexcept {
    if (pixels > most_) return clipping::kTooMuch;
    return static_cast<std::uint8_t>((pixels * clipping::kMostLevel + area_ - 1) / area_);
  }

 private:
  int area_;
  int most_;
  bool looked_for_;
};

/// Pixel: std::uint8_t or std::uint16_t. The constructor allocates all memory.
/// Not thread-safe; one instance per thread and slice.
template <typename Pixel>
class SharpnessRows {
 public:
  /// width >= 1; settings checked; format of the Pixel's size.
  SharpnessRows(int width, const FocusSettings& settings, PixelFormat format);

  /// Starts at row `first` of an image of the constructor's width and format. gain: of its light, see CodeScale.
  void begin(PlaneView<const Pixel> image, int first, double gain = 1.0) noexcept;

  /// Computes the next row: codes() and clipped() then hold it. Not called past the last row.
  void next() noexcept;

  /// Shape [width]; see sharpness_code.hpp.
  [[nodiscard]] const std::uint16_t* codes() const noexcept { return codes_.data(); }
  /// Shape [width], how much of the window is at full scale, see clipping; nullptr where none of the row's windows is.
  [[nodiscard]] const std::uint8_t* clipped() const noexcept {
    return saturated_rows_ == 0 ? nullptr : clipped_.data();
  }

  [[nodiscard]] static std::size_t memory_bytes(int width, const FocusSettings& settings);

 private:
  /// The sums of one width of integer: 16 bit for linear codes, 32 bit for all else. What is called second is empty for
  /// a single box.
  template <typename Sum>
  struct Columns {
    LargeArray<Sum> ring;           // [first side][pitch], values of the rows in the box, 0 where there is none
    LargeArray<Sum> fresh;          // [width], the row that enters
    LargeArray<Sum> sums;           // [width], over the box's rows
    LargeArray<Sum> scaled;         // [width], the same, shifted
    LargeArray<Sum> second_ring;    // [second side][pitch], such sums of the rows in the second box
    LargeArray<Sum> second_sums;    // [width], over the second box's rows
    LargeArray<Sum> second_scaled;  // [width], the same, shifted
    LargeArray<Sum> windows;        // [width]
  };
  /// The rows that are inside a box: [low, high).
  struct RowRange {
    int low = 0;
    int high = 0;
    /// Before any row: about `y`, the first.
    void begin(int y, int side, int height) noexcept {
      low = WindowReach(y, side / 2, height).first;
      high = low;
    }
    /// Rows enter and leave until the box is about `y`. A row that enters takes the slot of the one that is `side` rows
    /// above, which leaves by that.
    template <typename Enter, typename Leave>
    void move_to(int y, int side, int height, Enter enter, Leave leave) noexcept {
      const WindowReach reach(y, side / 2, height);
      while (high <= reach.last) {
        enter(high);
        if (high - side >= low) ++low;
        ++high;
      }
      while (low < reach.first) leave(low++);
    }
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
  void enter_second(Narrow& columns, int y) noexcept;
  void enter_second(Wide& columns, int y) noexcept;
  void leave_second(Narrow& columns, int y) noexcept;
  void leave_second(Wide& columns, int y) noexcept;
  template <typename Sum>
  void move_to(Columns<Sum>& columns) noexcept;
  template <typename Sum>
  [[nodiscard]] Sum* slot_of(LargeArray<Sum>& ring, int y, int side) const noexcept {
    return ring.data() + static_cast<std::ptrdiff_t>(y % side) * static_cast<std::ptrdiff_t>(pitch_);
  }
  void sum_windows(const std::uint16_t* values, int window, std::uint16_t* out) const noexcept;
  void sum_windows(const std::uint32_t* values, int window, std::uint32_t* out) const noexcept;
  void prefetch_row(int y) const noexcept;
  void compute_row(int y, std::uint32_t* out) noexcept;
  template <typename At>
  void for_ends(At at) noexcept;
  void emit_narrow() noexcept;
  void emit_wide() noexcept;
  [[nodiscard]] bool row_saturated(int y) const noexcept;
  void count_saturated(int y, int change) noexcept;
  void find_clipped() noexcept;
  void scale_codes() noexcept;

  const FocusKernels& kernels_;
  int width_;
  std::size_t pitch_;  // from a row of a ring to the next, elements: every row starts a cache line
  int window_;
  WindowSides sides_;
  int distance_;
  FocusOperator operator_;
  SharpnessCode code_;
  CodeScale scale_;  // of the present image
  int saturation_;
  ClippedLevels levels_;
  bool narrow_;
  PlaneView<const Pixel> image_;
  int y_ = 0;  // next row to emit
  RowRange first_;
  RowRange second_;
  RowRange counted_;        // those whose saturated pixels are counted
  int saturated_rows_ = 0;  // rows inside the window that hold a saturated pixel
  Narrow narrow_columns_;
  Wide wide_columns_;
  LargeArray<std::uint16_t> codes_;
  LargeArray<std::uint16_t> saturated_columns_;  // [width], saturated pixels in the window's rows, <= 63
  LargeArray<std::uint16_t> saturated_counts_;   // [width], over the window
  LargeArray<std::uint8_t> clipped_;
};

/// The same codes for a whole image, obviously correct: every window is summed anew. Shape of the image. For tests.
[[nodiscard]] Plane<std::uint16_t> sharpness_reference(const ImageView& image, const FocusSettings& settings,
                                                       double gain = 1.0);

extern template class SharpnessRows<std::uint8_t>;
extern template class SharpnessRows<std::uint16_t>;

}  // namespace fvd
