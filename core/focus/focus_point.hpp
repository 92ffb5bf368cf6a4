#pragma once

/// One pixel of a height map from the state of its focus curve: height, reasons, prominence.

#include <cstdint>
#include <span>

#include "core/focus/focus_settings.hpp"

namespace fvd {

/// The condensed focus curve of one pixel.
struct FocusCurve {
  std::uint32_t left = 0;
  std::uint32_t peak = 0;
  std::uint32_t right = 0;
  std::uint32_t minimum = 0;
  int peak_index = 0;
  bool saturated = false;
};

struct FocusPoint {
  float height_m = 0.0F;    ///< NaN exactly where mask != 0
  float prominence = 0.0F;  ///< (peak - minimum) / peak, 0 for a curve of zeros
  std::uint8_t mask = 0;    ///< mask_reason bits
};

/// z_um: measured z of every slice of the scan, at least one.
[[nodiscard]] FocusPoint resolve_point(const FocusCurve& curve, std::span<const double> z_um, PeakMethod method,
                                       double min_prominence) noexcept;

}  // namespace fvd
