#pragma once

/// The all-in-focus image in colour, beside a stack that measures with grey slices.

#include <span>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// Keeps the colour of each pixel's peak: 3 bytes per pixel, with bins 6. Nothing at all for a grey stack.
/// context: rows from many threads, each row from one.
class ColourTexture {
 public:
  /// For a grey stack: width and height 0.
  ColourTexture(int width, int height, int bin_slices);

  /// After the samples of these slices were taken in: peak_index as it is now, shape [width].
  void add_row(int y, const std::uint16_t* peak_index, std::span<const ZSlice> slices, int first_slice) noexcept;

  /// Colours of row y, shape [width][3]; pixels whose peak is sample `pending`, an incomplete bin, get that bin's.
  /// -1 = there is none.
  void copy_row(int y, const std::uint16_t* peak_index, int pending, std::uint8_t* out) const noexcept;

  [[nodiscard]] bool empty() const noexcept { return peak_.empty(); }
  [[nodiscard]] std::size_t memory_bytes() const noexcept { return peak_.pixels().size() + bin_.pixels().size(); }

 private:
  int width_;
  int bin_slices_;
  Plane<std::uint8_t> peak_;  // shape [height][3 * width]
  Plane<std::uint8_t> bin_;   // of the middle slice of the bin that is being filled
};

}  // namespace fvd
