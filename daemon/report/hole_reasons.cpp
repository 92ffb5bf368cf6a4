#include "daemon/report/hole_reasons.hpp"

#include <array>

namespace fvd {

std::span<const HoleReason> hole_reasons() {
  using namespace mask_reason;
  static constexpr std::array kReasons{
      HoleReason{kOutOfView, "out of view: not in every slice", 0x00808080},
      HoleReason{kSaturated, "saturated", 0x00E6194B},
      HoleReason{kFirstSlice, "sharpest at the first slice", 0x000082C8},
      HoleReason{kLastSlice, "sharpest at the last slice", 0x0046C8F0},
      HoleReason{kLowProminence, "low prominence: no texture", 0x003C3C3C},
      HoleReason{kInsignificant, "insignificant: too near the noise", 0x00AA6E28},
      HoleReason{kNotBracketed, "peak not bracketed", 0x00911EB4},
      HoleReason{kEdgeBleeding, "blur of a brighter edge", 0x00F58231},
      HoleReason{kBroadCurve, "focus curve too broad", 0x00008080},
      HoleReason{kNarrowCurve, "focus curve too narrow", 0x00D2F53C},
      HoleReason{kSecondPeak, "second peak", 0x00F032E6},
      HoleReason{kEdgeBand, "beside a wall", 0x00FFD21E},
      HoleReason{kMaxSigma, "standard error too large", 0x00000080},
      HoleReason{kOutlier, "outlier", 0x003CB44B},
  };
  return kReasons;
}

}  // namespace fvd
