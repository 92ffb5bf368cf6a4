#pragma once

// From operator values to window sums and codes.
//
// In: rows of operator values or of column sums. Out: column sums advanced by one row, sums over a window of columns,
// codes. A running sum would make every pixel wait for the one before; here a window is composed of sums over powers of
// three, each an addition of whole rows.

#include "core/focus/kernels/focus_kernels_common.hpp"
#include "core/focus/kernels/kernel_vectors-inl.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

void slide_u32(std::uint32_t* columns, const std::uint32_t* entering, std::uint32_t* leaving, int width) noexcept {
  FVD_NO_ALIASING
  for (int x = 0; x < width; ++x) {
    columns[x] += entering[x] - leaving[x];
    leaving[x] = entering[x];
  }
}

void slide_u16(std::uint16_t* columns, const std::uint16_t* entering, std::uint16_t* leaving, int width, int shift,
               std::uint16_t* scaled) noexcept {
  const auto at = [=](int x) __attribute__((always_inline)) {
    Codes sum;
    Codes in;
    Codes out;
    load(columns + x, sum);
    load(entering + x, in);
    load(leaving + x, out);
    sum += in - out;
    store(sum, columns + x);
    store(in, leaving + x);
    if (shift > 0) scale_codes(shift, sum);
    store(sum, scaled + x);
  };
  if (width >= 16) return cover(0, width, at);
  for (int x = 0; x < width; ++x) {
    columns[x] = static_cast<std::uint16_t>(columns[x] + entering[x] - leaving[x]);
    leaving[x] = entering[x];
    scaled[x] = shift > 0 ? rounded_shift(columns[x], shift) : columns[x];
  }
}

void scale_u16(std::uint16_t* values, int shift, int width) noexcept {
  int x = 0;
  for (; x + 16 <= width; x += 16) {
    Codes some;
    load(values + x, some);
    scale_codes(shift, some);
    store(some, values + x);
  }
  for (; x < width; ++x) values[x] = rounded_shift(values[x], shift);
}

/// out[x] = sum of the rows at x. The pointers are parameters: from an array g++ would load them anew for every x.
template <typename T, typename... Rows>
inline __attribute__((always_inline)) void add_rows(int count, T* out, Rows... rows) {
  FVD_NO_ALIASING
  for (int x = 0; x < count; ++x) out[x] = static_cast<T>((rows[x] + ...));
}

template <std::size_t... kTerm, typename T>
inline __attribute__((always_inline)) void add_terms(std::index_sequence<kTerm...> /*terms*/, const T* const* terms,
                                                     int count, T* out) {
  add_rows(count, out, terms[kTerm]...);
}
template <int kTerms, typename T>
inline __attribute__((always_inline)) void add_terms(const T* const* terms, int count, T* out) {
  add_terms(std::make_index_sequence<kTerms>(), terms, count, out);
}

template <typename T>
inline __attribute__((always_inline)) void add_terms(const T* const* terms, int number, int count, T* out) {
  switch (number) {
    case 1:
      return add_terms<1>(terms, count, out);
    case 2:
      return add_terms<2>(terms, count, out);
    case 3:
      return add_terms<3>(terms, count, out);
    case 4:
      return add_terms<4>(terms, count, out);
    case 5:
      return add_terms<5>(terms, count, out);
    case 6:
      return add_terms<6>(terms, count, out);
    case 7:
      return add_terms<7>(terms, count, out);
    case 8:
      return add_terms<8>(terms, count, out);
    case 9:
      return add_terms<9>(terms, count, out);
    case 10:
      return add_terms<10>(terms, count, out);
    case 11:
      return add_terms<11>(terms, count, out);
    default:
      return;  // no window needs more: 63 = 7 * 9, 61 = 6 * 9 + 2 * 3 + 1
  }
}

/// A window in powers of three: sums of 3, then of 9 values, each from three of the level below, and at last the
/// window from what is largest. 9 takes 4 additions, 31 takes 8, 63 takes 10. count: windows, up to kWindowsPerPass.
constexpr int kWindowsPerPass = 1280;  // two of these halve a row of 2448
template <typename T>
inline __attribute__((always_inline)) void window_sums_at(const T* values, int window, int count, T* out) {
  T scratch[2][kWindowsPerPass + 64];
  const T* level = values;
  const T* levels[3] = {values, values, values};
  int power = 1;
  int top = 0;
  while (top < 2 && power * 9 <= window) {
    const T* const terms[3] = {level, level + power, level + 2 * power};
    add_terms<3>(terms, count + window - 3 * power, scratch[top]);
    power *= 3;
    level = scratch[top];
    ++top;
    levels[top] = level;
  }
  const T* terms[12];
  int number = 0;
  int offset = 0;
  for (; top >= 0; --top, power /= 3) {
    while (offset + power <= window) {
      terms[number++] = levels[top] + offset;
      offset += power;
    }
  }
  add_terms(terms, number, count, out);
}

/// In passes of kWindowsPerPass windows, so that the intermediate sums stay in the nearest cache.
template <typename T>
inline __attribute__((always_inline)) void window_sums(const T* values, int window, int width, T* out) {
  const int windows = width - window + 1;
  for (int first = 0; first < windows; first += kWindowsPerPass) {
    const int count = windows - first < kWindowsPerPass ? windows - first : kWindowsPerPass;
    window_sums_at(values + first, window, count, out + first);
  }
}
void window_sums_u16(const std::uint16_t* values, int window, int width, std::uint16_t* out) noexcept {
  window_sums(values, window, width, out);
}
void window_sums_u32(const std::uint32_t* values, int window, int width, std::uint32_t* out) noexcept {
  window_sums(values, window, width, out);
}

void root_code(const std::uint32_t* sums, float gain, int width, std::uint16_t* out) noexcept {
  FVD_NO_ALIASING
  for (int x = 0; x < width; ++x) {
    // Through int: there is no vector instruction from unsigned to float before AVX-512. Pixels with more bits than
    // their format has may make more of a sum than it holds: they have no sharpness.
    const auto word = static_cast<std::int32_t>(sums[x]);
    const float root = std::sqrt(static_cast<float>(word < 0 ? 0 : word));
    // Not negative, and lround() is no vector instruction. NOLINTNEXTLINE(bugprone-incorrect-roundings)
    out[x] = static_cast<std::uint16_t>(static_cast<std::int32_t>(gain * root + 0.5F));
  }
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
