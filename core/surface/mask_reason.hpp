#pragma once

/// The reasons why a point of a surface is a hole.

#include <cstdint>

namespace fvd {

/// Why a point is a hole; reasons add up. 0 = valid.
namespace mask_reason {
inline constexpr std::uint8_t kLowProminence = 1U << 0U;  ///< no texture: the focus curve has no peak worth the name
inline constexpr std::uint8_t kFirstSlice =
    1U << 1U;  ///< sharpest at the first slice: the surface may lie below the range
inline constexpr std::uint8_t kLastSlice = 1U << 2U;      ///< sharpest at the last slice: it may lie above
inline constexpr std::uint8_t kNotBracketed = 1U << 3U;   ///< the neighbours do not enclose a maximum
inline constexpr std::uint8_t kSaturated = 1U << 4U;      ///< a pixel at full scale inside the window at the peak
inline constexpr std::uint8_t kInsignificant = 1U << 5U;  ///< the peak stands too little above the noise
inline constexpr std::uint8_t kEdgeBleeding = 1U << 6U;   ///< the blur of a far brighter edge next to it, no surface
}  // namespace mask_reason

}  // namespace fvd
