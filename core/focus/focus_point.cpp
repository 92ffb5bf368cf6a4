#include "core/focus/focus_point.hpp"

#include <limits>

#include "core/focus/height_map.hpp"
#include "core/focus/peak_fit.hpp"
#include "core/units.hpp"

namespace fvd {

FocusPoint resolve_point(const FocusCurve& curve, std::span<const double> z_um, PeakMethod method,
                         double min_prominence) noexcept {
  FocusPoint point;
  point.height_m = std::numeric_limits<float>::quiet_NaN();
  if (curve.peak > 0) {
    point.prominence = static_cast<float>(static_cast<double>(curve.peak - curve.minimum) / curve.peak);
  }
  unsigned mask = 0;
  if (curve.peak == 0 || static_cast<double>(point.prominence) < min_prominence) mask |= mask_reason::kLowProminence;
  if (curve.saturated) mask |= mask_reason::kSaturated;
  const auto index = static_cast<std::size_t>(curve.peak_index);
  if (index == 0) mask |= mask_reason::kFirstSlice;
  if (index + 1 == z_um.size()) mask |= mask_reason::kLastSlice;
  if ((mask & (mask_reason::kFirstSlice | mask_reason::kLastSlice)) == 0) {
    const auto z =
        fit_peak_um(method, {z_um[index - 1], z_um[index], z_um[index + 1], curve.left, curve.peak, curve.right});
    if (!z) {
      mask |= mask_reason::kNotBracketed;
    } else if (mask == 0) {
      point.height_m = static_cast<float>(*z * kMetresPerMicrometer);
    }
  }
  point.mask = static_cast<std::uint8_t>(mask);
  return point;
}

}  // namespace fvd
