#pragma once

/// One pixel's focus curve about its peak, for what is estimated from a whole scan: the stage's errors, the curves'
/// shape.

#include <array>
#include <cmath>
#include <cstddef>

namespace fvd {

/// Five samples about the peak of a point whose own curve gives no reason for a hole. Edge bleeding, which only the
/// neighbouring points reveal, is not excluded.
struct CurveTuple {
  int index = 0;  ///< number of the peak's sample, neither the first nor the last
  std::array<float, 5>
      share{};         ///< sharpness over the floor as a share of the peak's: two before, 1, two after; 0 = none
  float noise = 0.0F;  ///< standard deviation of a share
  float height_um = 0.0F;
};

/// Index, 0 .. count - 1, of the i-th tuple of a selection that is spread evenly over `count` tuples. Every n-th tuple
/// would not do: tuples come in rows and columns, and every n-th may lie in the same columns throughout.
[[nodiscard]] inline std::size_t spread_index(std::size_t i, std::size_t count) noexcept {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double place = static_cast<double>(i) * kGoldenRatio;
  return static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(count));
}

}  // namespace fvd
