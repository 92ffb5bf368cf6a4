#pragma once

// Quantities of a point that need its neighbours.
//
// In: rows of peaks, or rows of heights with those `reach` above and below. Out: the largest rise of a column so far,
// and sigma with the contribution of the slope. A missing neighbour (NaN) is a selection, not a branch: both sides are
// computed.

#include "core/focus/kernels/focus_kernels_common.hpp"

namespace fvd::FVD_KERNEL_NAMESPACE {

void raise_amplitudes(const std::uint16_t* peak, const std::uint16_t* minimum, bool root_code, int width,
                      std::uint32_t* highest) noexcept {
  FVD_NO_ALIASING
  for (int x = 0; x < width; ++x) {
    const std::uint32_t high = peak[x];
    const std::uint32_t low = minimum[x];
    const std::uint32_t amplitude = root_code ? high * high - low * low : high - low;
    highest[x] = amplitude > highest[x] ? amplitude : highest[x];
  }
}

bool any_apart(const std::uint16_t* a, const std::uint16_t* b, const MaskReasons* mask_a, const MaskReasons* mask_b,
               int width, std::uint16_t most) noexcept {
  std::uint16_t any = 0;
  for (int x = 0; x < width; ++x) {
    const std::uint16_t high = a[x] > b[x] ? a[x] : b[x];
    const std::uint16_t low = a[x] > b[x] ? b[x] : a[x];
    const auto apart = static_cast<std::uint16_t>(high - low);
    const auto weak = static_cast<std::uint16_t>((mask_a[x] | mask_b[x]) & mask_reason::kInsignificant);
    const std::uint16_t more = apart > most ? 1 : 0;
    any = static_cast<std::uint16_t>(any | (weak == 0 ? more : std::uint16_t{0}));
  }
  return any != 0;
}

void finish_sigma(const float* height, const float* upper, const float* lower, int reach, float factor, int width,
                  float* sigma) noexcept {
  const int first = upper != nullptr && 2 * reach < width ? reach : width;
  const int end = upper != nullptr && 2 * reach < width ? width - reach : width;
  for (int x = 0; x < first; ++x) sigma[x] = std::sqrt(sigma[x]);
  const float scale = factor / static_cast<float>(2 * reach);
  FVD_NO_ALIASING
  for (int x = first; x < end; ++x) {
    const float across = height[x + reach] - height[x - reach];
    const float along = lower[x] - upper[x];
    const float gx = across == across ? across * scale : 0.0F;  // NaN where a neighbour is a hole
    const float gy = along == along ? along * scale : 0.0F;
    sigma[x] = std::sqrt(sigma[x] + gx * gx + gy * gy);
  }
  for (int x = end; x < width; ++x) sigma[x] = std::sqrt(sigma[x]);
}

}  // namespace fvd::FVD_KERNEL_NAMESPACE
