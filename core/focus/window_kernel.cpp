#include "core/focus/window_kernel.hpp"

#include <cstddef>

namespace fvd {

LateralKernel window_kernel(const FocusSettings& settings) {
  const WindowSides sides = window_sides(settings);
  const double weight = 1.0 / (static_cast<double>(sides.first) * sides.second);
  std::vector<double> weights(static_cast<std::size_t>(sides.first + sides.second - 1), 0.0);
  for (int i = 0; i < sides.first; ++i) {
    for (int j = 0; j < sides.second; ++j) weights[static_cast<std::size_t>(i + j)] += weight;
  }
  return {weights};
}

}  // namespace fvd
