#pragma once

// Vectors of 16 pixels, and prefetching, for the fragments in which a loop over plain arrays is not fast enough.
//
// In: pointers to at least 16 values, of any alignment. Out: vectors of 16 lanes, by reference, because a vector wider
// than the target's own must not be returned. Lanes are 16 bits wide, as codes are; 8-bit values are widened when they
// are loaded. Written in the vectors that g++ and clang share, which work on every target, in two halves where its
// registers are narrower; intrinsics only where g++ 12 makes more than one instruction of an operator.

#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

using Codes = std::uint16_t __attribute__((vector_size(32), may_alias));
using Flags = std::uint8_t __attribute__((vector_size(16), may_alias));
using CodeMask = std::int16_t __attribute__((vector_size(32), may_alias));

template <typename Vector, typename T>
inline __attribute__((always_inline)) void load(const T* from, Vector& vector) {
  __builtin_memcpy(&vector, from, sizeof vector);
}
template <typename Vector, typename T>
inline __attribute__((always_inline)) void store(const Vector& vector, T* to) {
  __builtin_memcpy(to, &vector, sizeof vector);
}

/// The state has room for whole vectors; the image has not: what lies behind its last column is not read.
template <typename Vector, typename T>
inline __attribute__((always_inline)) void load_pixels(const T* from, int count, Vector& vector) {
  if (count >= 16) return load(from, vector);
  T values[16] = {};
  for (int i = 0; i < count; ++i) values[i] = from[i];
  load(values, vector);
}

inline __attribute__((always_inline)) void load_wide(const std::uint8_t* from, Codes& vector) {
  Flags narrow;
  load(from, narrow);
#if defined(FVD_KERNEL_AVX2)  // g++ 12 converts in two halves
  const __m256i wide = _mm256_cvtepu8_epi16(reinterpret_cast<const __m128i&>(narrow));
  vector = reinterpret_cast<const Codes&>(wide);
#else
  vector = __builtin_convertvector(narrow, Codes);
#endif
}

/// sum += |difference|, the difference taken as signed.
inline __attribute__((always_inline)) void add_size(const Codes& difference, Codes& sum) {
#if defined(FVD_KERNEL_AVX2)
  const __m256i size = _mm256_abs_epi16(reinterpret_cast<const __m256i&>(difference));
#else
  const CodeMask signs = reinterpret_cast<const CodeMask&>(difference) >> 15;
  const CodeMask size = (reinterpret_cast<const CodeMask&>(difference) ^ signs) - signs;
#endif
  sum += reinterpret_cast<const Codes&>(size);
}

/// value / 2 rounded up.
inline __attribute__((always_inline)) void halve(Codes& value) {
#if defined(FVD_KERNEL_AVX2)
  const __m256i half = _mm256_avg_epu16(reinterpret_cast<const __m256i&>(value), _mm256_setzero_si256());
  value = reinterpret_cast<const Codes&>(half);
#else
  value = (value >> 1) + (value & 1);
#endif
}

/// 16 values / 2^shift, rounded; shift >= 1.
inline __attribute__((always_inline)) void scale_codes(int shift, Codes& values) {
  values >>= shift - 1;
  halve(values);
}

/// v / 2^shift rounded, without overflow at the top of the range. shift >= 1.
inline std::uint16_t rounded_shift(std::uint16_t value, int shift) {
  return static_cast<std::uint16_t>((value >> shift) + ((value >> (shift - 1)) & 1));
}

/// Calls at(x) for vectors of 16 that cover first .. end - 1, at least 16 columns. Those between the ends are aligned
/// as column 0 is; those at the ends overlap them, so at(x) must give the same where it has been called before.
template <typename At>
inline __attribute__((always_inline)) void cover(int first, int end, At at) {
  at(first);
  for (int x = (first + 16) / 16 * 16; x + 16 <= end; x += 16) at(x);
  at(end - 16);
}

using Four = float __attribute__((vector_size(16), may_alias));

/// Number n of each of four rows goes to columns[n].
inline __attribute__((always_inline)) void transpose(const float* row0, const float* row1, const float* row2,
                                                     const float* row3, float* column0, float* column1, float* column2,
                                                     float* column3) {
  Four rows[4];
  load(row0, rows[0]);
  load(row1, rows[1]);
  load(row2, rows[2]);
  load(row3, rows[3]);
  const Four low01 = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5);
  const Four high01 = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7);
  const Four low23 = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);
  const Four high23 = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
  store(__builtin_shufflevector(low01, low23, 0, 1, 4, 5), column0);
  store(__builtin_shufflevector(low01, low23, 2, 3, 6, 7), column1);
  store(__builtin_shufflevector(high01, high23, 0, 1, 4, 5), column2);
  store(__builtin_shufflevector(high01, high23, 2, 3, 6, 7), column3);
}

/// Prefetches kBytes that lie `pitch_bytes` behind `from`: a row's fields are far apart, and the processor's own
/// prefetcher needs some misses in each to notice. Always inline: g++ treats a function that only prefetches as one
/// without effect, and drops its call.
template <int kBytes, typename T>
inline __attribute__((always_inline)) void fetch(const T* from, std::ptrdiff_t pitch_bytes, bool to_write) {
  constexpr int kCacheLine = 64;
  const auto* const bytes = reinterpret_cast<const char*>(from) + pitch_bytes;
  for (int i = 0; i < kBytes; i += kCacheLine) {
    if (to_write) {
      __builtin_prefetch(bytes + i, 1, 2);
    } else {
      __builtin_prefetch(bytes + i, 0, 2);
    }
  }
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
