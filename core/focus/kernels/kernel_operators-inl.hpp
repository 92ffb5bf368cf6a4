#pragma once

// The sharpness of a pixel.
//
// In: the pixel's row and those `distance` above and below. Out: the operator's value of each pixel except those within
// `distance` of an end. Plain loops in 32 bits, of which g++ makes vector code. The 8-bit Laplacian, which is the
// default, runs in 16-bit lanes and in one pass with the column sums, so that its values are never stored and loaded
// again.

#include "core/focus/kernels/focus_kernels_common.hpp"
#include "core/focus/kernels/kernel_vectors-inl.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

void laplacian_u16(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below, int width,
                   int distance, std::uint32_t* out) noexcept {
  FVD_NO_ALIASING
  for (int x = distance; x < width - distance; ++x) {
    const int horizontal = 2 * row[x] - row[x - distance] - row[x + distance];
    const int vertical = 2 * row[x] - above[x] - below[x];
    out[x] =
        static_cast<std::uint32_t>((horizontal < 0 ? -horizontal : horizontal) + (vertical < 0 ? -vertical : vertical));
  }
}

template <typename Pixel>
inline __attribute__((always_inline)) void tenengrad(const Pixel* above, const Pixel* row, const Pixel* below,
                                                     int width, int d, int prescale, int shift, std::uint32_t* out) {
  FVD_NO_ALIASING
  for (int x = d; x < width - d; ++x) {
    const int right = above[x + d] + 2 * row[x + d] + below[x + d];
    const int left = above[x - d] + 2 * row[x - d] + below[x - d];
    const int lower = below[x - d] + 2 * below[x] + below[x + d];
    const int upper = above[x - d] + 2 * above[x] + above[x + d];
    const int gx = (right - left) >> prescale;
    const int gy = (lower - upper) >> prescale;
    out[x] = static_cast<std::uint32_t>(gx * gx + gy * gy) >> shift;
  }
}

void tenengrad_u8(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                  int distance, int shift, std::uint32_t* out) noexcept {
  tenengrad(above, row, below, width, distance, 0, shift, out);
}
// 16 bit: a gradient has 18 bits and a sign; without its lowest 3 the sum of the squares fits 31 bits.
void tenengrad_u16(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below, int width,
                   int distance, int shift, std::uint32_t* out) noexcept {
  tenengrad(above, row, below, width, distance, 3, shift, out);
}

// Laplacian and column sums in one pass. The differences lie within -510..510, so 16-bit lanes do.
void enter_laplacian_u8(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                        int distance, int shift, std::uint16_t* columns, std::uint16_t* slot,
                        std::uint16_t* scaled) noexcept {
  int x = distance;
  const int end = width - distance;
  for (; x + 16 <= end; x += 16) {
    Codes centre;
    Codes left;
    Codes right;
    Codes upper;
    Codes lower;
    load_wide(row + x, centre);
    load_wide(row + x - distance, left);
    load_wide(row + x + distance, right);
    load_wide(above + x, upper);
    load_wide(below + x, lower);
    centre += centre;
    Codes value{};
    add_size(centre - left - right, value);
    add_size(centre - upper - lower, value);
    Codes sum;
    Codes leaving;
    load(columns + x, sum);
    load(slot + x, leaving);
    sum += value - leaving;
    store(sum, columns + x);
    store(value, slot + x);
    if (shift > 0) {
      sum >>= shift - 1;
      halve(sum);
    }
    store(sum, scaled + x);
  }
  for (; x < end; ++x) {
    const int horizontal = 2 * row[x] - row[x - distance] - row[x + distance];
    const int vertical = 2 * row[x] - above[x] - below[x];
    const int value = (horizontal < 0 ? -horizontal : horizontal) + (vertical < 0 ? -vertical : vertical);
    columns[x] = static_cast<std::uint16_t>(columns[x] + value - slot[x]);
    slot[x] = static_cast<std::uint16_t>(value);
    scaled[x] = shift > 0 ? rounded_shift(columns[x], shift) : columns[x];
  }
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
