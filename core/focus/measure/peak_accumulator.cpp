#include "core/focus/measure/peak_accumulator.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/focus/measure/sharpness_code.hpp"

namespace fvd {

namespace {

constexpr std::size_t kCurveFields = 9;

/// A valley lies below this share of what makes a second peak.
constexpr double kValley = 0.75;

std::size_t padded(int width) { return (static_cast<std::size_t>(width) + 15) / 16 * 16; }

}  // namespace

StateParts state_parts(const FocusSettings& settings, PixelFormat format) noexcept {
  const double share = kValley * settings.tests.second_peak;
  const double of_code = sharpness_code(settings, format).root ? std::sqrt(share) : share;
  return {settings.bin_slices > 1, static_cast<std::uint16_t>(std::lround(of_code * 65536.0))};
}

template <typename Texture>
std::size_t PeakAccumulator<Texture>::blocks_per_row(int width, const StateParts& parts) {
  const std::size_t fields = kCurveFields + (parts.valley_share > 0 ? 1 : 0);
  const std::size_t plain = fields * sizeof(std::uint16_t) + sizeof(Texture) + 1;
  const std::size_t bin = parts.bins ? sizeof(std::uint16_t) + sizeof(Texture) + 1 : 0;
  return (padded(width) * (plain + bin) + sizeof(Block) - 1) / sizeof(Block);
}

template <typename Texture>
PeakAccumulator<Texture>::PeakAccumulator(int width, int height, const StateParts& parts, KeptPagesPtr pages)
    : padded_width_(padded(width)),
      blocks_per_row_(blocks_per_row(width, parts)),
      parts_(parts),
      storage_(blocks_per_row_ * static_cast<std::size_t>(height), std::move(pages)) {}

template <typename Texture>
std::size_t PeakAccumulator<Texture>::memory_bytes(int width, int height, const StateParts& parts) {
  return blocks_per_row(width, parts) * sizeof(Block) * static_cast<std::size_t>(height);
}

template <typename Texture>
void PeakAccumulator<Texture>::touch_rows(int first, int end) noexcept {
  if (first >= end) return;
  constexpr std::size_t kBlocksPerPage = 4096 / sizeof(Block);
  const std::size_t stop = static_cast<std::size_t>(end) * blocks_per_row_;
  for (std::size_t i = static_cast<std::size_t>(first) * blocks_per_row_; i < stop; i += kBlocksPerPage) {
    storage_[i] = Block{};
  }
  storage_[stop - 1] = Block{};  // of the last page, where the rows begin in the middle of one
}

template <typename Texture>
void PeakAccumulator<Texture>::copy_row(const PeakAccumulator& from, int y) noexcept {
  std::copy_n(from.storage_.data() + static_cast<std::size_t>(y) * blocks_per_row_, blocks_per_row_, storage_.data());
}

template <typename Texture>
StateRow<Texture> PeakAccumulator<Texture>::row(int y) noexcept {
  std::byte* next = storage_[static_cast<std::size_t>(y) * blocks_per_row_].bytes;
  // Widest fields first, so that each starts aligned to its own size.
  const auto take = [&]<typename Field>(Field*& field) {
    field = reinterpret_cast<Field*>(next);
    next += padded_width_ * sizeof(Field);
  };
  StateRow<Texture> row;
  for (std::uint16_t** field :
       {&row.curve.previous, &row.curve.previous2, &row.curve.peak, &row.curve.left, &row.curve.left2, &row.curve.right,
        &row.curve.right2, &row.curve.minimum, &row.curve.peak_index}) {
    take(*field);
  }
  if (parts_.valley_share > 0) {
    take(row.curve.second);
    row.curve.valley_share = parts_.valley_share;
  }
  if (parts_.bins) take(row.bin.sums);
  take(row.texture);
  if (parts_.bins) take(row.bin.texture);
  take(row.curve.clipped);
  if (parts_.bins) take(row.bin.clipped);
  if (storage_.size() > blocks_per_row_) {
    row.curve.pitch_bytes = static_cast<std::ptrdiff_t>(blocks_per_row_ * sizeof(Block));
  }
  return row;
}

int bin_shift(int bin_slices) noexcept {
  int shift = 0;
  while ((1 << shift) < bin_slices) ++shift;
  return shift;
}

template <typename Texture>
void start_peaks(const StateRow<Texture>& row, const Sample<Texture>& sample, int width) noexcept {
  const CurveRow& curve = row.curve;
  std::copy_n(sample.codes, width, curve.previous);
  std::copy_n(sample.codes, width, curve.peak);
  std::copy_n(sample.codes, width, curve.minimum);
  for (std::uint16_t* field : {curve.previous2, curve.left, curve.left2, curve.right, curve.right2, curve.peak_index}) {
    std::fill_n(field, width, std::uint16_t{0});
  }
  if (curve.second != nullptr) std::fill_n(curve.second, width, std::uint16_t{0});
  std::copy_n(sample.pixels, width, row.texture);
  for (int x = 0; x < width; ++x) {
    const std::uint8_t level = sample.clipped == nullptr ? std::uint8_t{0} : sample.clipped[x];
    curve.clipped[x] = static_cast<std::uint8_t>((level == clipping::kTooMuch ? clipping::kNoPeak : 0) | level);
  }
}

template <typename Texture>
void update_peaks(const FocusKernels& kernels, const StateRow<Texture>& row, std::span<const Sample<Texture>> samples,
                  int width, int first_index) noexcept {
  const int count = static_cast<int>(samples.size());
  if constexpr (std::is_same_v<Texture, std::uint8_t>) {
    kernels.update_u8(row.curve, samples.data(), count, row.texture, width, first_index);
  } else {
    kernels.update_u16(row.curve, samples.data(), count, row.texture, width, first_index);
  }
}

template class PeakAccumulator<std::uint8_t>;
template class PeakAccumulator<std::uint16_t>;
template void start_peaks(const StateRow<std::uint8_t>&, const Sample<std::uint8_t>&, int) noexcept;
template void start_peaks(const StateRow<std::uint16_t>&, const Sample<std::uint16_t>&, int) noexcept;
template void update_peaks(const FocusKernels&, const StateRow<std::uint8_t>&, std::span<const Sample<std::uint8_t>>,
                           int, int) noexcept;
template void update_peaks(const FocusKernels&, const StateRow<std::uint16_t>&, std::span<const Sample<std::uint16_t>>,
                           int, int) noexcept;

}  // namespace fvd
