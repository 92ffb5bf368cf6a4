#pragma once

/// One pixel's focus curve about its peak, for what a scan says as a whole: the stage's errors, the curves' shape.

#include <array>
#include <cmath>
#include <cstddef>

namespace fvd {

/// Five samples about the peak, of a point that its own curve gives no reason to be a hole. The blur of a brighter
/// edge, which takes neighbours to tell, is not told here.
struct CurveTuple {
  int index = 0;                 ///< of the peak's sample, neither the first nor the last
  std::array<float, 5> share{};  ///< over the floor, of the peak's: two before, the peak (1), two after; 0 = none
  float noise = 0.0F;            ///< standard deviation of a share
  float height_um = 0.0F;
};

/// The i-th of some of `count` tuples, spread evenly over them, 0 .. count - 1. Not every n-th: tuples come in rows and
/// columns, and every n-th may be the same columns throughout.
[[nodiscard]] inline std::size_t spread_index(std::size_t i, std::size_t count) noexcept {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double place = static_cast<double>(i) * kGoldenRatio;
  return static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(count));
}

}  // namespace fvd
