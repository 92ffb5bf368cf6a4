#pragma once

/// What is kept per pixel of a focus curve that passes by once: its maximum so far with both neighbours, where it was,
/// and the minimum.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fvd {

/// One row's state as columns, shape [width] each. The fields of a row lie one behind the other, so that a row is one
/// stretch of memory. Texture: std::uint8_t for Mono8, else std::uint16_t.
template <typename Texture>
struct PeakRow {
  std::uint32_t* previous;    ///< sharpness of the slice before
  std::uint32_t* peak;        ///< largest sharpness so far; of equal ones the first
  std::uint32_t* left;        ///< sharpness of the slice before the peak, 0 at the first slice
  std::uint32_t* right;       ///< of the slice after the peak, 0 while there is none
  std::uint32_t* minimum;     ///< smallest sharpness so far
  std::uint16_t* peak_index;  ///< slice of the peak, 0-based
  Texture* texture;           ///< grey level at the peak
  std::uint8_t* saturated;    ///< 1 if a pixel of the window was saturated at the peak
};

/// 24 bytes a pixel for Mono8, 25 for 16 bit, plus padding of each row to 64 bytes; never grows.
template <typename Texture>
class PeakAccumulator {
 public:
  static constexpr std::size_t kBytesPerPixel = 5 * sizeof(std::uint32_t) + sizeof(std::uint16_t) + sizeof(Texture) + 1;

  PeakAccumulator(int width, int height);

  [[nodiscard]] PeakRow<Texture> row(int y) noexcept;
  [[nodiscard]] std::size_t memory_bytes() const noexcept { return storage_.size() * sizeof(Block); }
  [[nodiscard]] static std::size_t memory_bytes(int width, int height);

 private:
  struct alignas(64) Block {
    std::byte bytes[64];
  };
  [[nodiscard]] static std::size_t blocks_per_row(int width);

  std::size_t width_;
  std::size_t blocks_per_row_;
  std::vector<Block> storage_;
};

/// Takes slice 0 in: initialises the row. sharpness, saturated, pixels: shape [width].
template <typename Texture>
void start_peaks(const PeakRow<Texture>& row, const std::uint32_t* sharpness, const std::uint8_t* saturated,
                 const Texture* pixels, int width) noexcept;

/// Takes slice `index` >= 1 in. Branch-free per pixel.
template <typename Texture>
void update_peaks(const PeakRow<Texture>& row, const std::uint32_t* sharpness, const std::uint8_t* saturated,
                  const Texture* pixels, int width, int index) noexcept;

extern template class PeakAccumulator<std::uint8_t>;
extern template class PeakAccumulator<std::uint16_t>;

}  // namespace fvd
