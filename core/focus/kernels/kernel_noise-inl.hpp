#pragma once

// The noise of an image from its second differences.
//
// In: three neighbouring rows. Out: the sum over the row of the absolute values of Immerkaer's operator. Partial sums
// are as narrow as they can be without overflow: the narrower the lane, the more of them fit in a register.

#include "core/focus/kernels/focus_kernels_common.hpp"
#include "core/focus/kernels/kernel_vectors-inl.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

template <typename Pixel, typename Wide>
inline __attribute__((always_inline)) std::uint64_t noise(const Pixel* above, const Pixel* row, const Pixel* below,
                                                          int width) {
  // 32-bit partial sums: 8 * 65535 * 4096 < 2^31.
  std::uint64_t total = 0;
  for (int first = 1; first < width - 1; first += 4096) {
    const int end = first + 4096 < width - 1 ? first + 4096 : width - 1;
    std::uint32_t sum = 0;
    for (int x = first; x < end; ++x) {
      const auto middle = static_cast<Wide>(above[x] - 2 * row[x] + below[x]);
      const auto left = static_cast<Wide>(above[x - 1] - 2 * row[x - 1] + below[x - 1]);
      const auto right = static_cast<Wide>(above[x + 1] - 2 * row[x + 1] + below[x + 1]);
      const auto value = static_cast<Wide>(left + right - 2 * middle);
      const auto size = static_cast<Wide>(value < 0 ? -value : value);
      sum += static_cast<std::uint32_t>(size);
    }
    total += sum;
  }
  return total;
}
/// above - 2 row + below of 16 pixels, to be read as signed.
inline __attribute__((always_inline)) void second_difference(const std::uint8_t* above, const std::uint8_t* row,
                                                             const std::uint8_t* below, Codes& difference) {
  Codes upper;
  Codes centre;
  Codes lower;
  load_wide(above, upper);
  load_wide(row, centre);
  load_wide(below, lower);
  difference = upper + lower - centre - centre;
}

std::uint64_t noise_u8(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                       int width) noexcept {
  // A value is at most 2040: 32 of them fit the 16 bits of a lane.
  std::uint64_t total = 0;
  int x = 1;
  while (x + 16 < width) {
    Codes sum{};
    for (int k = 0; k < 32 && x + 16 < width; ++k, x += 16) {
      Codes middle;
      Codes left;
      Codes right;
      second_difference(above + x, row + x, below + x, middle);
      second_difference(above + x - 1, row + x - 1, below + x - 1, left);
      second_difference(above + x + 1, row + x + 1, below + x + 1, right);
      add_size(left + right - middle - middle, sum);
    }
    std::uint16_t lanes[16];
    store(sum, lanes);
    for (const std::uint16_t lane : lanes) total += lane;
  }
  return total + noise<std::uint8_t, std::int16_t>(above + x - 1, row + x - 1, below + x - 1, width - x + 1);
}
std::uint64_t noise_u16(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                        int width) noexcept {
  return noise<std::uint16_t, std::int32_t>(above, row, below, width);
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
