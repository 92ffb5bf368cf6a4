#include "daemon/report/axis_ticks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fvd {

double round_step(double limit) {
  const double decade = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * decade <= limit) return factor * decade;
  }
  return decade;
}

AxisTicks axis_ticks(double low, double high, int count) {
  const double step = round_step((high - low) / std::max(count - 1, 1));
  AxisTicks ticks;
  ticks.decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  constexpr double kTolerance = 1e-9;  // a limit that is a multiple itself keeps its tick
  const double last = std::floor(high / step + kTolerance);
  for (double multiple = std::ceil(low / step - kTolerance); multiple <= last; multiple += 1.0) {
    ticks.values.push_back(multiple * step);
  }
  return ticks;
}

std::string fixed_text(double value, int decimals) {
  char text[64];
  const auto end = std::to_chars(std::begin(text), std::end(text), value, std::chars_format::fixed, decimals);
  std::string result(text, end.ec == std::errc() ? end.ptr : text);
  const bool zero = result.find_first_not_of("-0.") == std::string::npos;
  return zero && result.starts_with('-') ? result.substr(1) : result;
}

}  // namespace fvd
