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
                   int distance, int shift, std::uint32_t* out) noexcept {
  FVD_NO_ALIASING
  for (int x = distance; x < width - distance; ++x) {
    const int horizontal = 2 * row[x] - row[x - distance] - row[x + distance];
    const int vertical = 2 * row[x] - above[x] - below[x];
    const int sum = (horizontal < 0 ? -horizontal : horizontal) + (vertical < 0 ? -vertical : vertical);
    out[x] = static_cast<std::uint32_t>(sum) >> shift;
  }
}

inline __attribute__((always_inline)) int size_of(int value) { return value < 0 ? -value : value; }

/// Twice the modified Laplacian and the diagonals at both steps.
template <typename Pixel>
inline __attribute__((always_inline)) std::uint32_t diagonal_value(const DiagonalRows<Pixel>& rows, int x) {
  const int d = rows.distance;
  const int s = rows.inner;
  const int centre = 2 * rows.row[x];
  const int straight =
      size_of(centre - rows.row[x - d] - rows.row[x + d]) + size_of(centre - rows.above[x] - rows.below[x]);
  const int outer =
      size_of(centre - rows.above[x - d] - rows.below[x + d]) + size_of(centre - rows.above[x + d] - rows.below[x - d]);
  const int inner =
      size_of(centre - rows.upper[x - s] - rows.lower[x + s]) + size_of(centre - rows.upper[x + s] - rows.lower[x - s]);
  return static_cast<std::uint32_t>(2 * straight + outer + inner);
}

template <typename Pixel>
inline __attribute__((always_inline)) void diagonal(const DiagonalRows<Pixel>& given, int width, int shift,
                                                    std::uint32_t* out) {
  const DiagonalRows<Pixel> rows = given;  // a copy that out cannot alias
  FVD_NO_ALIASING
  for (int x = rows.distance; x < width - rows.distance; ++x) out[x] = diagonal_value(rows, x) >> shift;
}

void diagonal_u8(const DiagonalRows<std::uint8_t>& rows, int width, int shift, std::uint32_t* out) noexcept {
  diagonal(rows, width, shift, out);
}
void diagonal_u16(const DiagonalRows<std::uint16_t>& rows, int width, int shift, std::uint32_t* out) noexcept {
  diagonal(rows, width, shift, out);
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

/// A row's new values enter the column sums, those in the slot leave them; 16 pixels. Done again it changes nothing:
/// the slot holds the new values then.
inline __attribute__((always_inline)) void enter_values(const Codes& value, int shift, std::uint16_t* columns,
                                                        std::uint16_t* slot, std::uint16_t* scaled) {
  Codes sum;
  Codes leaving;
  load(columns, sum);
  load(slot, leaving);
  sum += value - leaving;
  store(sum, columns);
  store(value, slot);
  if (shift > 0) scale_codes(shift, sum);
  store(sum, scaled);
}
inline __attribute__((always_inline)) void enter_value(int value, int shift, std::uint16_t& column, std::uint16_t& slot,
                                                       std::uint16_t& scaled) {
  column = static_cast<std::uint16_t>(column + value - slot);
  slot = static_cast<std::uint16_t>(value);
  scaled = shift > 0 ? rounded_shift(column, shift) : column;
}

/// sum += |centre - one - other|
inline __attribute__((always_inline)) void add_difference(const Codes& centre, const std::uint8_t* one,
                                                          const std::uint8_t* other, Codes& sum) {
  Codes a;
  Codes b;
  load_wide(one, a);
  load_wide(other, b);
  add_size(centre - a - b, sum);
}

// Laplacian and column sums in one pass. The differences lie within -510..510, so 16-bit lanes do.
void enter_laplacian_u8(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                        int distance, int shift, std::uint16_t* columns, std::uint16_t* slot,
                        std::uint16_t* scaled) noexcept {
  const int end = width - distance;
  const auto at = [=](int x) __attribute__((always_inline)) {
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
    enter_values(value, shift, columns + x, slot + x, scaled + x);
  };
  if (end - distance >= 16) return cover(distance, end, at);
  for (int x = distance; x < end; ++x) {
    const int horizontal = 2 * row[x] - row[x - distance] - row[x + distance];
    const int vertical = 2 * row[x] - above[x] - below[x];
    enter_value(size_of(horizontal) + size_of(vertical), shift, columns[x], slot[x], scaled[x]);
  }
}

void enter_diagonal_u8(const DiagonalRows<std::uint8_t>& given, int width, int shift, std::uint16_t* columns,
                       std::uint16_t* slot, std::uint16_t* scaled) noexcept {
  const DiagonalRows<std::uint8_t> rows = given;
  const int d = rows.distance;
  const int s = rows.inner;
  const int end = width - d;
  const auto at = [=](int x) __attribute__((always_inline)) {
    Codes centre;
    load_wide(rows.row + x, centre);
    centre += centre;
    Codes value{};
    add_difference(centre, rows.row + x - d, rows.row + x + d, value);
    add_difference(centre, rows.above + x, rows.below + x, value);
    value += value;
    add_difference(centre, rows.above + x - d, rows.below + x + d, value);
    add_difference(centre, rows.above + x + d, rows.below + x - d, value);
    add_difference(centre, rows.upper + x - s, rows.lower + x + s, value);
    add_difference(centre, rows.upper + x + s, rows.lower + x - s, value);
    enter_values(value, shift, columns + x, slot + x, scaled + x);
  };
  if (end - d >= 16) return cover(d, end, at);
  for (int x = d; x < end; ++x) {
    enter_value(static_cast<int>(diagonal_value(rows, x)), shift, columns[x], slot[x], scaled[x]);
  }
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
