#include "core/focus/colour_texture.hpp"

#include <algorithm>

namespace fvd {

namespace {

void copy_where(const std::uint16_t* peak_index, int sample, int width, const std::uint8_t* from,
                std::uint8_t* to) noexcept {
  for (int x = 0; x < width; ++x) {
    if (peak_index[x] == sample) std::copy_n(from + 3 * x, 3, to + 3 * x);
  }
}

}  // namespace

ColourTexture::ColourTexture(int width, int height, int bin_slices)
    : width_(width),
      bin_slices_(bin_slices),
      peak_(3 * width, height),
      bin_(bin_slices > 1 ? 3 * width : 0, bin_slices > 1 ? height : 0) {}

void ColourTexture::add_row(int y, const std::uint16_t* peak_index, std::span<const ZSlice> slices,
                            int first_slice) noexcept {
  if (empty()) return;
  const std::uint8_t* candidate = bin_.empty() ? nullptr : bin_.row(y);
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const int number = first_slice + static_cast<int>(k);
    const int place = number % bin_slices_;
    if (place == 0 || place == (bin_slices_ - 1) / 2) {
      candidate = slices[k].colour + static_cast<std::ptrdiff_t>(y) * 3 * width_;
    }
    // Of several samples taken in at once only the one that is the peak by now finds itself named.
    if (place == bin_slices_ - 1) copy_where(peak_index, number / bin_slices_, width_, candidate, peak_.row(y));
  }
  const bool open = (first_slice + static_cast<int>(slices.size())) % bin_slices_ != 0;
  if (open && candidate != bin_.row(y)) std::copy_n(candidate, 3 * width_, bin_.row(y));
}

void ColourTexture::copy_row(int y, const std::uint16_t* peak_index, int pending, std::uint8_t* out) const noexcept {
  std::copy_n(peak_.row(y), 3 * width_, out);
  if (pending >= 0) copy_where(peak_index, pending, width_, bin_.row(y), out);
}

}  // namespace fvd
