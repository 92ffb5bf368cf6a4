#pragma once

/// The focus operators, value by value: the law for the kernels and for what they leave at the ends of a row.
/// context: thread-safe.

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/focus/kernels/focus_kernels.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"

namespace fvd {

/// The bits a 16-bit gradient loses before it is squared; see the kernel.
template <typename Pixel>
constexpr int kGradientShift = sizeof(Pixel) == 1 ? 0 : 3;

/// The diagonals' first step: half the distance, at least 1 px.
[[nodiscard]] inline int inner_step(int distance) noexcept { return std::max(1, distance / 2); }

/// Row y and those around it; beyond the image, the edge row.
template <typename Pixel>
[[nodiscard]] DiagonalRows<Pixel> rows_about(PlaneView<const Pixel> image, int y, int distance) noexcept {
  const int inner = inner_step(distance);
  const auto row = [&](int at) { return image.row(std::clamp(at, 0, image.height - 1)); };
  return {row(y - distance), row(y - inner), row(y), row(y + inner), row(y + distance), distance, inner};
}

/// The operator at column x of an image `width` wide; beyond the image, the edge pixel.
template <typename Pixel>
[[nodiscard]] std::uint32_t operator_value(FocusOperator op, const DiagonalRows<Pixel>& rows, int x, int width,
                                           int shift) noexcept {
  const auto column = [&](int at) { return std::clamp(at, 0, width - 1); };
  const int left = column(x - rows.distance);
  const int right = column(x + rows.distance);
  const Pixel* const above = rows.above;
  const Pixel* const row = rows.row;
  const Pixel* const below = rows.below;
  const auto difference = [&](Pixel one, Pixel other) { return std::abs(2 * row[x] - one - other); };
  switch (op) {
    case FocusOperator::kModifiedLaplacian:
      return static_cast<std::uint32_t>(difference(row[left], row[right]) + difference(above[x], below[x])) >> shift;
    case FocusOperator::kDiagonalLaplacian: {
      const int near_left = column(x - rows.inner);
      const int near_right = column(x + rows.inner);
      return static_cast<std::uint32_t>(2 * (difference(row[left], row[right]) + difference(above[x], below[x])) +
                                        difference(above[left], below[right]) + difference(above[right], below[left]) +
                                        difference(rows.upper[near_left], rows.lower[near_right]) +
                                        difference(rows.upper[near_right], rows.lower[near_left])) >>
             shift;
    }
    case FocusOperator::kTenengrad: {
      const int gx = (above[right] + 2 * row[right] + below[right] - above[left] - 2 * row[left] - below[left]) >>
                     kGradientShift<Pixel>;
      const int gy = (below[left] + 2 * below[x] + below[right] - above[left] - 2 * above[x] - above[right]) >>
                     kGradientShift<Pixel>;
      return static_cast<std::uint32_t>(gx * gx + gy * gy) >> shift;
    }
    case FocusOperator::kIntensity:
      return static_cast<std::uint32_t>(row[x]) >> shift;
  }
  return 0;
}

/// Both halves of a gradient's lost bits, of the operator that has gradients.
template <typename Pixel>
[[nodiscard]] constexpr int gradient_shift(FocusOperator op) noexcept {
  return op == FocusOperator::kTenengrad ? kGradientShift<Pixel> : 0;
}

}  // namespace fvd
