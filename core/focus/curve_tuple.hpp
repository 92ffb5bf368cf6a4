#pragma once

/// One pixel's focus curve about its peak, for what a scan says as a whole: the stage's errors, the curves' shape.

#include <array>

namespace fvd {

/// Five samples about the peak.
struct CurveTuple {
  int index = 0;                 ///< of the peak's sample
  std::array<float, 5> share{};  ///< over the floor, of the peak's: two before, the peak (1), two after; 0 = none
  float noise = 0.0F;            ///< standard deviation of a share
  float height_um = 0.0F;
};

}  // namespace fvd
