#include "daemon/result/result.hpp"

#include <algorithm>

namespace fvd {

const MeasuredValue* Result::find(std::string_view name) const noexcept {
  const auto found = std::find_if(measurements.begin(), measurements.end(),
                                  [name](const MeasuredValue& value) { return value.name == name; });
  return found == measurements.end() ? nullptr : &*found;
}

double Result::valid_fraction() const noexcept {
  return points == 0 ? 0.0 : static_cast<double>(valid_points) / static_cast<double>(points);
}

}  // namespace fvd
