#pragma once

// Update of the condensed curves by samples.
//
// In: a row of the curves' state and successive samples of it. Out: the state after these samples, as if they had come
// one by one. 16 columns at a time, all samples one after the other, so that the state is loaded and stored once; that
// memory traffic limits the speed. If no lane has a new peak, the only branch skips half of the work.

#include "core/focus/kernels/focus_kernels_common.hpp"
#include "core/focus/kernels/kernel_second_peak-inl.hpp"
#include "core/focus/kernels/kernel_vectors-inl.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

template <typename Pixel>
inline __attribute__((always_inline)) Pixel maximum(const Pixel* row, int width) {
  Pixel largest = 0;
  for (int x = 0; x < width; ++x) largest = row[x] > largest ? row[x] : largest;
  return largest;
}
std::uint8_t maximum_u8(const std::uint8_t* row, int width) noexcept { return maximum(row, width); }
std::uint16_t maximum_u16(const std::uint16_t* row, int width) noexcept { return maximum(row, width); }

void add_to_bin(std::uint16_t* sums, const std::uint16_t* codes, int shift, int width) noexcept {
  FVD_NO_ALIASING
  for (int x = 0; x < width; ++x) sums[x] = static_cast<std::uint16_t>(sums[x] + rounded_shift(codes[x], shift));
}

void widen_u8(const std::uint8_t* values, std::ptrdiff_t pitch_bytes, int width, std::uint16_t* out) noexcept {
  constexpr int kBlock = 64;
  for (int first = 0; first < width; first += kBlock) {
    fetch<kBlock>(values + first, pitch_bytes, false);
    fetch<2 * kBlock>(out + first, std::ptrdiff_t{2} * width, true);
    const int end = first + kBlock < width ? first + kBlock : width;
    FVD_NO_ALIASING
    for (int x = first; x < end; ++x) out[x] = values[x];
  }
}

/// Whether all lanes are set; each is 0 or -1.
inline __attribute__((always_inline)) bool all(const CodeMask& mask) {
#if defined(FVD_KERNEL_AVX2)
  return _mm256_movemask_epi8(reinterpret_cast<const __m256i&>(mask)) == -1;
#else
  std::uint64_t words[4];
  __builtin_memcpy(words, &mask, sizeof words);
  return (words[0] & words[1] & words[2] & words[3]) == ~std::uint64_t{0};
#endif
}

using FlagMask = std::int8_t __attribute__((vector_size(16), may_alias));

inline __attribute__((always_inline)) void narrow_mask(const CodeMask& wide, FlagMask& narrow) {
#if defined(FVD_KERNEL_AVX2)
  __m128i halves[2];
  __builtin_memcpy(halves, &wide, sizeof halves);
  const __m128i packed = _mm_packs_epi16(halves[0], halves[1]);
  narrow = reinterpret_cast<const FlagMask&>(packed);
#else
  narrow = __builtin_convertvector(wide, FlagMask);
#endif
}

/// A sample's levels are taken in: where the peak stays, and where it has only just been; elsewhere the peak is this
/// sample. Masks in lanes of 0 or -1.
inline __attribute__((always_inline)) void take_levels(const Flags& levels, const FlagMask& stays,
                                                       const FlagMask& follows, Flags& clipped) {
  const Flags before = clipped & clipping::kLevelBits;
  const Flags known = clipped & clipping::kPeakBits;
  const Flags none{};
  const Flags lost = none + clipping::kNoPeak;
  // This sample is the peak.
  Flags fresh = before < levels ? none + clipping::kRose : none;
  fresh = before > levels ? none + clipping::kFell : fresh;
  fresh = before > levels + clipping::kMostGrowth ? lost : fresh;
  fresh = levels == none + clipping::kTooMuch ? lost : fresh;
  // The sample before is.
  Flags settled = before > none ? none + clipping::kSome : none;
  settled = before >= none + clipping::kManyLevel ? none + clipping::kMany : settled;
  const FlagMask grows = (levels > before + clipping::kMostGrowth) | (known == lost) |
                         ((levels > before) & (known == none + clipping::kRose)) |
                         ((levels < before) & (known == none + clipping::kFell));
  settled = grows ? lost : settled;
  const Flags kept = follows ? settled : known;
  clipped = (stays ? kept : fresh) | levels;
}

/// Whether any of 16 columns at x has a clipped pixel in its window, or had one before.
template <typename Texture>
inline __attribute__((always_inline)) bool any_clipped(const CurveRow& row, const Sample<Texture>* samples, int count,
                                                       int x, int there) {
  Flags any;
  load(row.clipped + x, any);
  for (int k = 0; k < count; ++k) {
    if (samples[k].clipped == nullptr) continue;
    Flags levels;
    load_pixels(samples[k].clipped + x, there, levels);
    any |= levels;
  }
  std::uint64_t words[2];
  __builtin_memcpy(words, &any, sizeof words);
  return (words[0] | words[1]) != 0;
}

/// Takes one sample's shares of clipped pixels in, nullptr for none.
template <typename Level>
inline __attribute__((always_inline)) void take_clipped(const Level* shares, int there, const CodeMask& stays,
                                                        const CodeMask& follows, Flags& clipped) {
  Flags levels{};
  if (shares != nullptr) load_pixels(shares, there, levels);
  FlagMask narrow_stays;
  narrow_mask(stays, narrow_stays);
  FlagMask narrow_follows;
  narrow_mask(follows, narrow_follows);
  take_levels(levels, narrow_stays, narrow_follows, clipped);
}

/// 16 columns at x. The state stays in registers while several samples are taken in. there: columns from x on that the
/// image has, 16 if more.
template <typename Texture, typename TextureVector, bool kClipped, bool kSecond>
inline __attribute__((always_inline)) void update_at(const CurveRow& row, const Sample<Texture>* samples, int count,
                                                     Texture* texture_row, int x, int there, int first_index) {
  Codes previous;
  load(row.previous + x, previous);
  Codes previous2;
  load(row.previous2 + x, previous2);
  Codes peak;
  load(row.peak + x, peak);
  Codes left;
  load(row.left + x, left);
  Codes left2;
  load(row.left2 + x, left2);
  Codes right;
  load(row.right + x, right);
  Codes right2;
  load(row.right2 + x, right2);
  Codes minimum;
  load(row.minimum + x, minimum);
  Codes age;  // samples since the peak's
  load(row.peak_index + x, age);
  age = static_cast<std::uint16_t>(first_index) - age;
  TextureVector texture;
  load(texture_row + x, texture);
  Flags clipped{};
  if constexpr (kClipped) load(row.clipped + x, clipped);
  SecondPeaks second{};
  if constexpr (kSecond) load_second(row, x, peak, second);
  for (int k = 0; k < count; ++k) {
    const Sample<Texture>& sample = samples[k];
    Codes value;
    load_pixels(sample.codes + x, there, value);
    const CodeMask follows = age == 1;
    const Codes higher = value > peak ? value : peak;
    const CodeMask stays = higher == peak;
    minimum = value < minimum ? value : minimum;
    right = follows ? value : right;
    right2 = age == 2 ? value : right2;
    if constexpr (kClipped) {
      take_clipped(sample.clipped == nullptr ? nullptr : sample.clipped + x, there, stays, follows, clipped);
    }
    if constexpr (kSecond) take_second(value, peak, age, second);
    // In most slices of a scan 16 neighbours are all past their peak, or before it in the noise.
    if (!all(stays)) {
      TextureVector pixels;
      load_pixels(sample.pixels + x, there, pixels);
      const auto keep = reinterpret_cast<const Codes&>(stays);
      left = stays ? left : previous;
      left2 = stays ? left2 : previous2;
      right &= keep;
      right2 &= keep;
      peak = higher;
      age &= keep;
      if constexpr (kSecond) restart_second(peak, keep, row.valley_share, second);
      if constexpr (sizeof(Texture) == 1) {
        FlagMask narrow;
        narrow_mask(stays, narrow);
        texture = narrow ? texture : pixels;
      } else {
        texture = stays ? texture : pixels;
      }
    }
    age += 1;
    previous2 = previous;
    previous = value;
  }
  const Codes peak_index = static_cast<std::uint16_t>(first_index + count) - age;
  store(previous, row.previous + x);
  store(previous2, row.previous2 + x);
  store(peak, row.peak + x);
  store(left, row.left + x);
  store(left2, row.left2 + x);
  store(right, row.right + x);
  store(right2, row.right2 + x);
  store(minimum, row.minimum + x);
  store(peak_index, row.peak_index + x);
  store(texture, texture_row + x);
  if constexpr (kClipped) store(clipped, row.clipped + x);
  if constexpr (kSecond) store(second.code, row.second + x);
}

template <typename Texture, typename TextureVector, bool kSecond>
inline __attribute__((always_inline)) void update_columns(const CurveRow& row, const Sample<Texture>* samples,
                                                          int count, Texture* texture, int x, int there,
                                                          int first_index) {
  if (any_clipped(row, samples, count, x, there)) {
    update_at<Texture, TextureVector, true, kSecond>(row, samples, count, texture, x, there, first_index);
  } else {
    update_at<Texture, TextureVector, false, kSecond>(row, samples, count, texture, x, there, first_index);
  }
}

/// The next row's state below the 32 pixels from x on, which is written as well as read.
template <typename Texture, bool kSecond>
inline __attribute__((always_inline)) void fetch_below(const CurveRow& row, const Texture* texture, int x) {
  for (const std::uint16_t* field : {row.previous, row.previous2, row.peak, row.left, row.left2, row.right, row.right2,
                                     row.minimum, row.peak_index}) {
    fetch<64>(field + x, row.pitch_bytes, true);
  }
  fetch<32 * sizeof(Texture)>(texture + x, row.pitch_bytes, true);
  fetch<32>(row.clipped + x, row.pitch_bytes, true);
  if constexpr (kSecond) fetch<64>(row.second + x, row.pitch_bytes, true);
}

template <typename Texture, typename TextureVector, bool kSecond>
inline __attribute__((always_inline)) void update(const CurveRow& row, const Sample<Texture>* samples, int count,
                                                  Texture* texture, int width, int first_index) {
  int x = 0;
  for (; x + 16 <= width; x += 16) {
    if (x % 32 == 0) fetch_below<Texture, kSecond>(row, texture, x);
    update_columns<Texture, TextureVector, kSecond>(row, samples, count, texture, x, 16, first_index);
  }
  if (x < width)
    update_columns<Texture, TextureVector, kSecond>(row, samples, count, texture, x, width - x, first_index);
}
void update_u8(const CurveRow& row, const Sample<std::uint8_t>* samples, int count, std::uint8_t* texture, int width,
               int first_index) noexcept {
  if (row.second == nullptr) {
    update<std::uint8_t, Flags, false>(row, samples, count, texture, width, first_index);
  } else {
    update<std::uint8_t, Flags, true>(row, samples, count, texture, width, first_index);
  }
}
void update_u16(const CurveRow& row, const Sample<std::uint16_t>* samples, int count, std::uint16_t* texture, int width,
                int first_index) noexcept {
  if (row.second == nullptr) {
    update<std::uint16_t, Codes, false>(row, samples, count, texture, width, first_index);
  } else {
    update<std::uint16_t, Codes, true>(row, samples, count, texture, width, first_index);
  }
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
