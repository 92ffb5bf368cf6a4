#include "core/stage/quantile.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fvd {

double quantile(std::vector<double> values, double p) {
  assert(!values.empty() && p >= 0.0 && p <= 1.0);
  std::sort(values.begin(), values.end());
  const double place = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace fvd
