#include "core/focus/peak_accumulator.hpp"

#include <algorithm>

#include "core/focus/vector_clones.hpp"

namespace fvd {

namespace {

template <typename Texture>
inline __attribute__((always_inline)) void update(
    std::uint32_t* __restrict previous, std::uint32_t* __restrict peak, std::uint32_t* __restrict left,
    std::uint32_t* __restrict right, std::uint32_t* __restrict minimum, std::uint16_t* __restrict peak_index,
    Texture* __restrict texture, std::uint8_t* __restrict saturated_at_peak, const std::uint32_t* __restrict sharpness,
    const std::uint8_t* __restrict saturated, const Texture* __restrict pixels, int width, std::uint16_t index) {
  const auto before = static_cast<std::uint16_t>(index - 1);
  for (int x = 0; x < width; ++x) {
    const std::uint32_t value = sharpness[x];
    const bool higher = value > peak[x];
    const bool follows_peak = peak_index[x] == before;
    left[x] = higher ? previous[x] : left[x];
    const std::uint32_t kept = follows_peak ? value : right[x];
    right[x] = higher ? 0U : kept;
    peak[x] = higher ? value : peak[x];
    minimum[x] = value < minimum[x] ? value : minimum[x];
    peak_index[x] = higher ? index : peak_index[x];
    texture[x] = higher ? pixels[x] : texture[x];
    saturated_at_peak[x] = higher ? saturated[x] : saturated_at_peak[x];
    previous[x] = value;
  }
}

FVD_VECTOR_CLONES void update_row(const PeakRow<std::uint8_t>& row, const std::uint32_t* sharpness,
                                  const std::uint8_t* saturated, const std::uint8_t* pixels, int width,
                                  std::uint16_t index) {
  update(row.previous, row.peak, row.left, row.right, row.minimum, row.peak_index, row.texture, row.saturated,
         sharpness, saturated, pixels, width, index);
}
FVD_VECTOR_CLONES void update_row(const PeakRow<std::uint16_t>& row, const std::uint32_t* sharpness,
                                  const std::uint8_t* saturated, const std::uint16_t* pixels, int width,
                                  std::uint16_t index) {
  update(row.previous, row.peak, row.left, row.right, row.minimum, row.peak_index, row.texture, row.saturated,
         sharpness, saturated, pixels, width, index);
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
