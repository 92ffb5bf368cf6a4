#pragma once

/// Feeds slices to a row of focus curves: each as a sample of its own, or summed to bins first.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/focus/measure/peak_accumulator.hpp"

namespace fvd {

/// Summing successive sharpness rows uses every slice of a finely stepped scan without keeping any: the noise of a
/// sample falls with the root of the bin, and the samples get the distance at which a peak is located best.
/// Texture: the pixel of the bin's middle slice. Clipping: the highest level of the bin's slices.
/// Not thread-safe; one instance per thread.
template <typename Texture>
class SliceBinner {
 public:
  SliceBinner(int width, int bin_slices)
      : kernels_(focus_kernels()),
        width_(width),
        bin_(bin_slices),
        shift_(bin_shift(bin_slices)),
        scaled_(static_cast<std::size_t>(bin_slices > 1 ? width : 0)) {}

  /// Takes a row of successive slices in; the number of the first is first_slice, 0-based.
  void add(const StateRow<Texture>& row, std::span<const Sample<Texture>> slices, int first_slice) noexcept {
    if (bin_ == 1) {
      take(row, slices, first_slice);
      return;
    }
    for (const Sample<Texture>& slice : slices) add_to_bin(row, slice, first_slice++);
  }

  /// Takes an incomplete last bin in: its sums are raised to those of a full one. `pending` slices, 1 .. bin - 1.
  void close(const StateRow<Texture>& row, int samples, int pending) noexcept {
    for (int x = 0; x < width_; ++x) {
      const unsigned full = row.bin.sums[x] * static_cast<unsigned>(bin_) / static_cast<unsigned>(pending);
      scaled_[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(std::min(full, 65535U));
    }
    const Sample<Texture> sample{scaled_.data(), row.bin.clipped, row.bin.texture};
    take(row, std::span(&sample, 1), samples - 1);
  }

 private:
  void add_to_bin(const StateRow<Texture>& row, const Sample<Texture>& slice, int number) noexcept {
    const BinRow<Texture>& bin = row.bin;
    const int place = number % bin_;
    if (place == 0) {
      std::fill_n(bin.sums, width_, std::uint16_t{0});
      std::fill_n(bin.clipped, width_, std::uint8_t{0});
    }
    kernels_.add_to_bin(bin.sums, slice.codes, shift_, width_);
    if (slice.clipped != nullptr) {
      for (int x = 0; x < width_; ++x) bin.clipped[x] = std::max(bin.clipped[x], slice.clipped[x]);
    }
    if (place == (bin_ - 1) / 2 || place == 0) std::copy_n(slice.pixels, width_, bin.texture);
    const Sample<Texture> sample{bin.sums, bin.clipped, bin.texture};
    if (place == bin_ - 1) take(row, std::span(&sample, 1), number / bin_);
  }

  void take(const StateRow<Texture>& row, std::span<const Sample<Texture>> samples, int first_index) noexcept {
    if (first_index == 0) {
      start_peaks(row, samples.front(), width_);
      samples = samples.subspan(1);
      ++first_index;
    }
    if (!samples.empty()) update_peaks(kernels_, row, samples, width_, first_index);
  }

  const FocusKernels& kernels_;
  int width_;
  int bin_;
  int shift_;
  std::vector<std::uint16_t> scaled_;
};

}  // namespace fvd
