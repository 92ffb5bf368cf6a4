#include "core/focus/measure/sharpness_code.hpp"

#include <algorithm>
#include <cmath>

namespace fvd {

namespace {

/// The largest code: roundings on the way up must not pass 65535.
constexpr double kMaxCode = 65000.0;
constexpr double kMaxWord = 65535.0;
constexpr double kMaxSum = 2147483000.0;  // the root is taken of a signed 32-bit integer

double largest_value(FocusOperator op, int grey) {
  switch (op) {
    case FocusOperator::kModifiedLaplacian:
      return 4.0 * grey;
    case FocusOperator::kDiagonalLaplacian:
      return 16.0 * grey;
    case FocusOperator::kTenengrad:
      return 32.0 * grey * grey;
    case FocusOperator::kIntensity:
      return grey;
  }
  return 4.0 * grey;
}

/// At most, after a shift that rounds.
double rounded(double sum, int shift) { return std::ldexp(sum, -shift) + (shift > 0 ? 1.0 : 0.0); }

/// The least shift after which so many sums add up to no more than `top`.
int least_shift(double sum, int count, double top) {
  int shift = 0;
  while (count * rounded(sum, shift) > top) ++shift;
  return shift;
}

}  // namespace

CodeScale::CodeScale(double gain, FocusOperator focus_operator, bool root) noexcept {
  if (std::abs(gain - 1.0) < 0.0005 || focus_operator == FocusOperator::kIntensity) return;
  if (root && focus_operator != FocusOperator::kTenengrad) gain = std::sqrt(gain);
  factor_ = static_cast<std::uint32_t>(std::clamp(std::round(gain * kOne), 0.0, 65535.0));
}

float root_gain(const SharpnessCode& code, int gradient_shift) noexcept {
  return static_cast<float>(code.gain * std::sqrt(std::ldexp(1.0, code.operator_shift + 2 * gradient_shift)));
}

SharpnessCode sharpness_code(const FocusSettings& settings, PixelFormat format) noexcept {
  SharpnessCode code;
  const WindowSides sides = window_sides(settings);
  double largest = largest_value(settings.focus_operator, max_grey_level(format));
  const bool laplacian = settings.focus_operator == FocusOperator::kModifiedLaplacian ||
                         settings.focus_operator == FocusOperator::kDiagonalLaplacian;
  if (format == PixelFormat::kMono8 && laplacian && sides.first * largest <= kMaxWord) {
    double sum = sides.first * largest;  // over a column, the largest
    if (sides.second == 1) {
      code.shift = least_shift(sum, sides.first, kMaxCode);
    } else {
      code.shift = least_shift(sum, sides.second, kMaxWord);
      sum = sides.second * rounded(sum, code.shift);
      code.second_shift = least_shift(sum, sides.first, kMaxWord);
      sum = sides.first * rounded(sum, code.second_shift);
      code.third_shift = least_shift(sum, sides.second, kMaxCode);
    }
    code.gain = std::ldexp(1.0, -code.shift - code.second_shift - code.third_shift);
    return code;
  }
  const double window = sides.first * sides.second;  // the root of the sum of the weights
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
