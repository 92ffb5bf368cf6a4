#pragma once

/// The state per pixel of a focus curve whose samples are seen once: its maximum so far with two neighbours on either
/// side, the number of the maximum's sample, and the minimum.

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/focus/kernels/focus_kernels.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// Slices that are being summed to one sample; all nullptr if every slice is a sample.
template <typename Texture>
struct BinRow {
  std::uint16_t* sums = nullptr;
  Texture* texture = nullptr;       ///< of the slice in the middle of the bin
  std::uint8_t* clipped = nullptr;  ///< the highest level of the bin, see clipping
};

template <typename Texture>
struct StateRow {
  CurveRow curve;
  Texture* texture = nullptr;
  BinRow<Texture> bin;
};

/// What a state keeps beside the peak and its neighbours.
struct StateParts {
  bool bins = false;
  /// Of the peak's code, in 65536ths, see second_peak; 0 = no second peak.
  std::uint16_t valley_share = 0;
};
[[nodiscard]] StateParts state_parts(const FocusSettings& settings, PixelFormat format) noexcept;

/// 20 bytes per pixel for Mono8, 21 for 16 bit, with bins 24 and 26, 2 more with the second peak; rows padded to 16
/// pixels; never grows.
/// Texture: std::uint8_t for Mono8, else std::uint16_t. context: several threads may use different rows.
template <typename Texture>
class PeakAccumulator {
 public:
  PeakAccumulator(int width, int height, const StateParts& parts, KeptPagesPtr pages = nullptr);

  [[nodiscard]] StateRow<Texture> row(int y) noexcept;
  /// Writes into each page of rows first to end - 1, so that they exist before the first slice, near the thread that
  /// calls. Not the whole rows: that takes tens of milliseconds for a large image, and the first motion waits for it.
  void touch_rows(int first, int end) noexcept;
  /// Row 0 becomes a copy of row y of another accumulator of the same width and kind.
  void copy_row(const PeakAccumulator& from, int y) noexcept;
  [[nodiscard]] std::size_t memory_bytes() const noexcept { return storage_.size() * sizeof(Block); }
  [[nodiscard]] static std::size_t memory_bytes(int width, int height, const StateParts& parts);

 private:
  struct alignas(32) Block {  // a vector of codes
    std::byte bytes[32];
  };
  [[nodiscard]] static std::size_t blocks_per_row(int width, const StateParts& parts);

  std::size_t padded_width_;
  std::size_t blocks_per_row_;
  StateParts parts_;
  LargeArray<Block> storage_;
};

/// Number of bits by which the codes of a bin's slices are shifted so that their sum fits 16 bits: 0 for 1 slice, 6 for
/// 64.
[[nodiscard]] int bin_shift(int bin_slices) noexcept;

/// Takes sample 0 in: initialises the row.
template <typename Texture>
void start_peaks(const StateRow<Texture>& row, const Sample<Texture>& sample, int width) noexcept;

/// Takes successive samples in; the number of the first is first_index >= 1.
template <typename Texture>
void update_peaks(const FocusKernels& kernels, const StateRow<Texture>& row, std::span<const Sample<Texture>> samples,
                  int width, int first_index) noexcept;

extern template class PeakAccumulator<std::uint8_t>;
extern template class PeakAccumulator<std::uint16_t>;

}  // namespace fvd
