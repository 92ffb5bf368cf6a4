#pragma once

/// The reasons why a point of a surface is a hole.

#include <cstdint>

namespace fvd {

/// Why one point is a hole: the sum of mask_reason bits. 0 = valid.
using MaskReasons = std::uint16_t;

/// Bit numbers are part of the files' format 2. Bit 13 belongs to a reason that nothing finds yet: no tile.
namespace mask_reason {
inline constexpr MaskReasons kLowProminence = 1U << 0U;  ///< no texture: the focus curve has no peak worth the name
inline constexpr MaskReasons kFirstSlice = 1U << 1U;     ///< sharpest at the first slice: the surface may lie beyond it
inline constexpr MaskReasons kLastSlice = 1U << 2U;      ///< sharpest at the last slice: the surface may lie beyond it
inline constexpr MaskReasons kNotBracketed = 1U << 3U;   ///< the peak's neighbours do not enclose a maximum
inline constexpr MaskReasons kSaturated =
    1U << 4U;  ///< too much of the window is at full scale, or more so beside the peak
inline constexpr MaskReasons kInsignificant = 1U << 5U;  ///< the peak stands too little above the noise
inline constexpr MaskReasons kEdgeBleeding = 1U << 6U;   ///< the peak is the blur of a far brighter edge, no surface
inline constexpr MaskReasons kBroadCurve = 1U << 7U;  ///< the curve is far broader than the scan's: blur from elsewhere
inline constexpr MaskReasons kNarrowCurve = 1U << 8U;  ///< far narrower: a pixel that blinks, dust that moved, a flash
inline constexpr MaskReasons kSecondPeak = 1U << 9U;   ///< the curve has another peak of nearly the same height
inline constexpr MaskReasons kEdgeBand = 1U << 10U;    ///< beside a wall, whose sharpness reaches across it
inline constexpr MaskReasons kMaxSigma = 1U << 11U;    ///< the standard error is larger than the recipe allows
inline constexpr MaskReasons kOutlier = 1U << 12U;     ///< far from its neighbours or from the fitted form
inline constexpr MaskReasons kOutOfView = 1U << 14U;   ///< at the border, where drift was undone: not in every slice
}  // namespace mask_reason

}  // namespace fvd
