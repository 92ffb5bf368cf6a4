#pragma once

/// Round numbers for scales.

#include <string>
#include <vector>

namespace fvd {

/// The largest of 1, 2, 5 x 10^n that is not above limit > 0.
[[nodiscard]] double round_step(double limit);

struct AxisTicks {
  std::vector<double> values;  ///< multiples of one round step inside [low, high]
  int decimals = 0;            ///< as many as tell neighbouring values apart
};

/// About `count` ticks, low < high.
[[nodiscard]] AxisTicks axis_ticks(double low, double high, int count);

/// The value with this number of decimals, never "-0".
[[nodiscard]] std::string fixed_text(double value, int decimals);

}  // namespace fvd
