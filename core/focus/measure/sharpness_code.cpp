#include "core/focus/measure/sharpness_code.hpp"

#include <cmath>

namespace fvd {

namespace {

/// The largest code: roundings on the way up must not pass 65535.
constexpr double kMaxCode = 65000.0;
constexpr double kMaxSum = 2147483000.0;  // the root is taken of a signed 32-bit integer

double largest_value(FocusOperator op, int grey) {
  switch (op) {
    case FocusOperator::kModifiedLaplacian:
      return 4.0 * grey;
    case FocusOperator::kTenengrad:
      return 32.0 * grey * grey;
    case FocusOperator::kIntensity:
      return grey;
  }
  return 4.0 * grey;
}

}  // namespace

SharpnessCode sharpness_code(const FocusSettings& settings, PixelFormat format) noexcept {
  SharpnessCode code;
  const double window = settings.window_px;
  double largest = largest_value(settings.focus_operator, max_grey_level(format));
  if (format == PixelFormat::kMono8 && settings.focus_operator == FocusOperator::kModifiedLaplacian) {
    while (window * (window * largest / (1 << code.shift) + 1.0) > kMaxCode) ++code.shift;
    code.gain = 1.0 / (1 << code.shift);
    return code;
  }
  code.root = true;
  // The kernel for 16 bit drops 3 bits of each gradient before it squares.
  const int lost = settings.focus_operator == FocusOperator::kTenengrad && format != PixelFormat::kMono8 ? 6 : 0;
  largest = std::ldexp(largest, -lost);
  while (window * window * std::ldexp(largest, -code.operator_shift) > kMaxSum) ++code.operator_shift;
  const double largest_sum = window * window * std::ldexp(largest, -code.operator_shift);
  code.gain = kMaxCode / std::sqrt(std::ldexp(largest_sum, lost + code.operator_shift));
  return code;
}

}  // namespace fvd
