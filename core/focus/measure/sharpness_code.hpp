#pragma once

/// The 16-bit code of a window's sum, which is what is kept per sample.
///
///   linear:  code = F * gain               8-bit Laplacians of windows that 16-bit sums hold; gain is a power of 1/2
///   root:    code = round(gain * sqrt(F))  everything wider: 16 bits keep the precision of small sums
///
/// Both rise with F, so a peak of codes is a peak of F. share(F), linear code / 65535 or its square for root codes, is
/// what the fits work with.

#include <cstdint>

#include "core/focus/measure/focus_settings.hpp"
#include "core/image/image.hpp"

namespace fvd {

struct SharpnessCode {
  bool root = false;
  int shift = 0;         ///< linear: right shift of the sum over a column, 0..6 bits
  int second_shift = 0;  ///< linear, double box: right shift of the sum of such sums over the second box's column, bits
  int third_shift = 0;   ///< linear, double box: right shift of the sum of those along the row over the first box, bits
  int operator_shift = 0;  ///< right shift of an operator's value before it is summed, bits
  double gain = 1.0;       ///< from F, the sum of the operator's unshifted values, to the code

  static constexpr double kUnit = 1.0 / 65535.0;  ///< a code times this is a share or the root of one

  /// The value F of a code, for messages and tests.
  [[nodiscard]] double decode(std::uint16_t code) const noexcept {
    const double value = code / gain;
    return root ? value * value : value;
  }
};

/// A factor on codes that takes the light of a slice to that of the others. Integer, so that all ways of computing
/// agree.
class CodeScale {
 public:
  CodeScale() = default;
  /// gain: of the light, 0..3.99; within 0.0005 of 1 it is none. F rises with the light, Tenengrad's with its square;
  /// root: codes hold the root of F. The intensity is not scaled: it is no measure of contrast.
  CodeScale(double gain, FocusOperator focus_operator, bool root) noexcept;
  [[nodiscard]] bool none() const noexcept { return factor_ == kOne; }
  [[nodiscard]] std::uint16_t apply(std::uint16_t code) const noexcept {
    // 65535 * 65535 + 8192 fits 32 bits.
    const std::uint32_t scaled = (code * factor_ + kOne / 2) >> kBits;
    return static_cast<std::uint16_t>(scaled < 65535U ? scaled : 65535U);
  }
  bool operator==(const CodeScale&) const = default;

 private:
  static constexpr int kBits = 14;
  static constexpr std::uint32_t kOne = 1U << kBits;
  std::uint32_t factor_ = kOne;
};

/// What the root kernel multiplies the root of a sum with, whose values lack operator_shift bits and, being squares,
/// twice gradient_shift.
[[nodiscard]] float root_gain(const SharpnessCode& code, int gradient_shift) noexcept;

[[nodiscard]] SharpnessCode sharpness_code(const FocusSettings& settings, PixelFormat format) noexcept;

}  // namespace fvd
