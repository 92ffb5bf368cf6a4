#include "core/focus/peak_accumulator.hpp"

#include <algorithm>

#include "core/focus/vector_clones.hpp"

namespace fvd {

namespace {

/// `one` where the mask is all ones, `other` where it is 0. With masks no path forks: from ?: on several planes g++ 12
/// makes branches, and a loop with branches stays scalar.
template <typename T>
inline T select(T mask, T one, T other) {
  return static_cast<T>(other ^ ((one ^ other) & mask));
}

template <typename Texture>
inline __attribute__((always_inline)) void update(const PeakRow<Texture> row, const std::uint32_t* sharpness,
                                                  const std::uint8_t* saturated, const Texture* pixels, int width,
                                                  std::uint16_t index) {
  const auto before = static_cast<std::uint16_t>(index - 1);
  FVD_NO_ALIASING
  for (int x = 0; x < width; ++x) {
    const std::uint32_t value = sharpness[x];
    const std::uint32_t higher = 0U - static_cast<std::uint32_t>(value > row.peak[x]);
    const std::uint32_t follows_peak = 0U - static_cast<std::uint32_t>(row.peak_index[x] == before);
    row.left[x] = select(higher, row.previous[x], row.left[x]);
    row.right[x] = ~higher & select(follows_peak, value, row.right[x]);
    row.peak[x] = value > row.peak[x] ? value : row.peak[x];
    row.minimum[x] = value < row.minimum[x] ? value : row.minimum[x];
    row.peak_index[x] = select(static_cast<std::uint16_t>(higher), index, row.peak_index[x]);
    row.texture[x] = select(static_cast<Texture>(higher), pixels[x], row.texture[x]);
    row.saturated[x] = select(static_cast<std::uint8_t>(higher), saturated[x], row.saturated[x]);
    row.previous[x] = value;
  }
}

// Clones need a plain function each.
FVD_VECTOR_CLONES void update_row(const PeakRow<std::uint8_t>& row, const std::uint32_t* sharpness,
                                  const std::uint8_t* saturated, const std::uint8_t* pixels, int width,
                                  std::uint16_t index) {
  update(row, sharpness, saturated, pixels, width, index);
}
FVD_VECTOR_CLONES void update_row(const PeakRow<std::uint16_t>& row, const std::uint32_t* sharpness,
                                  const std::uint8_t* saturated, const std::uint16_t* pixels, int width,
                                  std::uint16_t index) {
  update(row, sharpness, saturated, pixels, width, index);
}

}  // namespace

template <typename Texture>
std::size_t PeakAccumulator<Texture>::blocks_per_row(int width) {
  return (static_cast<std::size_t>(width) * kBytesPerPixel + sizeof(Block) - 1) / sizeof(Block);
}

template <typename Texture>
PeakAccumulator<Texture>::PeakAccumulator(int width, int height)
    : width_(static_cast<std::size_t>(width)),
      blocks_per_row_(blocks_per_row(width)),
      storage_(blocks_per_row_ * static_cast<std::size_t>(height)) {}

template <typename Texture>
std::size_t PeakAccumulator<Texture>::memory_bytes(int width, int height) {
  return blocks_per_row(width) * sizeof(Block) * static_cast<std::size_t>(height);
}

template <typename Texture>
PeakRow<Texture> PeakAccumulator<Texture>::row(int y) noexcept {
  std::byte* bytes = storage_[static_cast<std::size_t>(y) * blocks_per_row_].bytes;
  // Widest fields first, so that each starts aligned to its own size.
  const auto words = [&](std::size_t field) {
    return reinterpret_cast<std::uint32_t*>(bytes + field * width_ * sizeof(std::uint32_t));
  };
  std::byte* rest = bytes + 5 * width_ * sizeof(std::uint32_t);
  auto* peak_index = reinterpret_cast<std::uint16_t*>(rest);
  auto* texture = reinterpret_cast<Texture*>(rest + width_ * sizeof(std::uint16_t));
  auto* saturated = reinterpret_cast<std::uint8_t*>(rest + width_ * (sizeof(std::uint16_t) + sizeof(Texture)));
  return {words(0), words(1), words(2), words(3), words(4), peak_index, texture, saturated};
}

template <typename Texture>
void start_peaks(const PeakRow<Texture>& row, const std::uint32_t* sharpness, const std::uint8_t* saturated,
                 const Texture* pixels, int width) noexcept {
  std::copy_n(sharpness, width, row.previous);
  std::copy_n(sharpness, width, row.peak);
  std::copy_n(sharpness, width, row.minimum);
  std::fill_n(row.left, width, 0U);
  std::fill_n(row.right, width, 0U);
  std::fill_n(row.peak_index, width, std::uint16_t{0});
  std::copy_n(pixels, width, row.texture);
  std::copy_n(saturated, width, row.saturated);
}

template <typename Texture>
void update_peaks(const PeakRow<Texture>& row, const std::uint32_t* sharpness, const std::uint8_t* saturated,
                  const Texture* pixels, int width, int index) noexcept {
  update_row(row, sharpness, saturated, pixels, width, static_cast<std::uint16_t>(index));
}

template class PeakAccumulator<std::uint8_t>;
template class PeakAccumulator<std::uint16_t>;
template void start_peaks(const PeakRow<std::uint8_t>&, const std::uint32_t*, const std::uint8_t*, const std::uint8_t*,
                          int) noexcept;
template void start_peaks(const PeakRow<std::uint16_t>&, const std::uint32_t*, const std::uint8_t*,
                          const std::uint16_t*, int) noexcept;
template void update_peaks(const PeakRow<std::uint8_t>&, const std::uint32_t*, const std::uint8_t*, const std::uint8_t*,
                           int, int) noexcept;
template void update_peaks(const PeakRow<std::uint16_t>&, const std::uint32_t*, const std::uint8_t*,
                           const std::uint16_t*, int, int) noexcept;

}  // namespace fvd
