#pragma once

/// The all-in-focus image in colour, for a stack that measures with grey slices.

#include <span>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// Keeps the colour of each pixel's peak: 3 bytes per pixel, 6 with bins, 0 for a grey stack.
/// context: rows from many threads, each row from one.
class ColourTexture {
 public:
  /// For a grey stack: width and height 0.
  ColourTexture(int width, int height, int bin_slices);

  /// To be called after the accumulator has taken in these slices. peak_index: its present state, shape [width].
  void add_row(int y, const std::uint16_t* peak_index, std::span<const ZSlice> slices, int first_slice) noexcept;

  /// Writes the colours of row y to `out`, shape [width][3]. pending: number of the incomplete bin, -1 = none; pixels
  /// whose peak is that sample get the colour of that bin.
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
