#pragma once

/// Feeds slices to a row of focus curves: each as a sample of its own, or summed to bins first.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/focus/peak_accumulator.hpp"

namespace fvd {

/// Summing successive sharpness rows uses every slice of a finely stepped scan without keeping any: the noise of a
/// sample falls with the root of the bin, and the samples get the distance at which a peak is placed best.
/// Texture and saturation: the pixel of the bin's middle slice, any saturated window of the bin.
/// context: one thread; one a thread.
template <typename Texture>
class SliceBinner {
 public:
  SliceBinner(int width, int bin_slices)
      : kernels_(focus_kernels()),
        width_(width),
        bin_(bin_slices),
        shift_(bin_shift(bin_slices)),
        scaled_(static_cast<std::size_t>(bin_slices > 1 ? width : 0)) {}

  /// Takes a row of slice `slice`, 0-based, in.
  void add(const StateRow<Texture>& row, const std::uint16_t* codes, const std::uint8_t* saturated,
           const Texture* pixels, int slice) noexcept {
    if (bin_ == 1) {
      sample(row, codes, saturated, pixels, slice);
      return;
    }
    const BinRow<Texture>& bin = row.bin;
    const int place = slice % bin_;
    if (place == 0) {
      std::fill_n(bin.sums, width_, std::uint16_t{0});
      std::fill_n(bin.saturated, width_, std::uint8_t{0});
    }
    kernels_.add_to_bin(bin.sums, codes, shift_, width_);
    for (int x = 0; x < width_; ++x) bin.saturated[x] = static_cast<std::uint8_t>(bin.saturated[x] | saturated[x]);
    if (place == (bin_ - 1) / 2 || place == 0) std::copy_n(pixels, width_, bin.texture);
    if (place == bin_ - 1) sample(row, bin.sums, bin.saturated, bin.texture, slice / bin_);
  }

  /// Takes an incomplete last bin in: its sums are raised to those of a full one. `pending` slices, 1 .. bin - 1.
  void close(const StateRow<Texture>& row, int samples, int pending) noexcept {
    for (int x = 0; x < width_; ++x) {
      const unsigned full = row.bin.sums[x] * static_cast<unsigned>(bin_) / static_cast<unsigned>(pending);
      scaled_[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(std::min(full, 65535U));
    }
    sample(row, scaled_.data(), row.bin.saturated, row.bin.texture, samples - 1);
  }

 private:
  void sample(const StateRow<Texture>& row, const std::uint16_t* codes, const std::uint8_t* saturated,
              const Texture* pixels, int index) noexcept {
    if (index == 0) {
      start_peaks(row, codes, saturated, pixels, width_);
    } else {
      update_peaks(kernels_, row, codes, saturated, pixels, width_, index);
    }
  }

  const FocusKernels& kernels_;
  int width_;
  int bin_;
  int shift_;
  std::vector<std::uint16_t> scaled_;
};

}  // namespace fvd
