#pragma once

// The second peak of curves while samples are taken in.
//
// In: a sample, the peak before it and the samples since that peak, 16 columns each. Out: the second peak's code, see
// second_peak in focus_kernels.hpp.

#include "core/focus/kernels/focus_kernels_common.hpp"
#include "core/focus/kernels/kernel_vectors-inl.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

struct SecondPeaks {
  Codes code;
  Codes valley;  ///< a sample below it parts the peak from what follows
};

inline __attribute__((always_inline)) void find_valley(const Codes& peak, std::uint16_t share, Codes& valley) {
#if defined(FVD_KERNEL_AVX2)
  const __m256i shares = _mm256_set1_epi16(static_cast<std::int16_t>(share));
  const __m256i high = _mm256_mulhi_epu16(reinterpret_cast<const __m256i&>(peak), shares);
  valley = reinterpret_cast<const Codes&>(high);
#else
  for (int x = 0; x < 16; ++x) valley[x] = second_peak::valley(peak[x], share);
#endif
}

inline __attribute__((always_inline)) void load_second(const CurveRow& row, int x, const Codes& peak,
                                                       SecondPeaks& second) {
  load(row.second + x, second.code);
  find_valley(peak, row.valley_share, second.valley);
}

/// Before the peak is: age counts the samples from the old peak to this one.
inline __attribute__((always_inline)) void take_second(const Codes& value, const Codes& peak, const Codes& age,
                                                       SecondPeaks& second) {
  const CodeMask low = value < second.valley;
  second.code |= reinterpret_cast<const Codes&>(low) & second_peak::kValleyBit;
  const CodeMask far = age >= second_peak::kDistance;
  const CodeMask parted = (second.code & second_peak::kValleyBit) != 0;
  const CodeMask counts = far & parted;
  // A sample above the peak overtakes it: what counts then is the old peak.
  const Codes lower = value < peak ? value : peak;
  const Codes candidate = (lower | second_peak::kValleyBit) & reinterpret_cast<const Codes&>(counts);
  second.code = candidate > second.code ? candidate : second.code;
}

/// After the peak is: no valley has been seen since the new ones. keep: all bits where the peak stays, else none.
inline __attribute__((always_inline)) void restart_second(const Codes& peak, const Codes& keep, std::uint16_t share,
                                                          SecondPeaks& second) {
  second.code &= keep | static_cast<std::uint16_t>(~second_peak::kValleyBit);
  find_valley(peak, share, second.valley);
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
