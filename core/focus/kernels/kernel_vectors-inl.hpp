// The compiler's own vectors, where loops over plain arrays do not do, and what to fetch. Part of
// focus_kernels-inl.hpp.

/// 16 pixels at once, in the compiler's own vectors, for loops that g++ makes poor vector code of by itself.
using Codes = std::uint16_t __attribute__((vector_size(32), may_alias));
using Flags = std::uint8_t __attribute__((vector_size(16), may_alias));
using CodeMask = std::int16_t __attribute__((vector_size(32), may_alias));

// By reference: a vector wider than the target's own is not to be returned.
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
  using Bytes = char __attribute__((vector_size(16)));
  const auto wide = __builtin_ia32_pmovzxbw256(reinterpret_cast<const Bytes&>(narrow));
  vector = reinterpret_cast<const Codes&>(wide);
#else
  vector = __builtin_convertvector(narrow, Codes);
#endif
}

/// sum += |difference|, the difference taken as signed.
inline __attribute__((always_inline)) void add_size(const Codes& difference, Codes& sum) {
#if defined(FVD_KERNEL_AVX2)
  using Words = short __attribute__((vector_size(32)));
  const auto size = __builtin_ia32_pabsw256(reinterpret_cast<const Words&>(difference));
#else
  const CodeMask signs = reinterpret_cast<const CodeMask&>(difference) >> 15;
  const CodeMask size = (reinterpret_cast<const CodeMask&>(difference) ^ signs) - signs;
#endif
  sum += reinterpret_cast<const Codes&>(size);
}

/// value / 2 rounded up.
inline __attribute__((always_inline)) void halve(Codes& value) {
#if defined(FVD_KERNEL_AVX2)
  using Words = short __attribute__((vector_size(32)));
  const auto half = __builtin_ia32_pavgw256(reinterpret_cast<const Words&>(value), Words{});
  value = reinterpret_cast<const Codes&>(half);
#else
  value = (value >> 1) + (value & 1);
#endif
}

/// What lies `pitch_bytes` behind `from`, so that it is there when its turn comes: a row's fields are far apart, and
/// the processor's own prefetcher needs some misses in each to notice. Always inline: g++ takes a function that does
/// nothing but this for one that does nothing, and drops its call.
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
