#include <cmath>
#include <cstdint>

#include "core/focus/measure/operator_value.hpp"
#include "core/focus/measure/sharpness_rows.hpp"

namespace fvd {

namespace {

/// The root kernel's arithmetic, in its order and precision.
std::uint16_t root_code(std::uint64_t sum, float gain) {
  const auto word = static_cast<std::int32_t>(sum);
  if (word < 0) return 0;  // as the kernel, of pixels with more bits than their format has
  const float root = std::sqrt(static_cast<float>(word));
  // As the kernel rounds, whose values are not negative. NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return static_cast<std::uint16_t>(static_cast<std::int32_t>(gain * root + 0.5F));
}

using Sums = Plane<std::uint64_t>;

std::uint64_t rounded(std::uint64_t value, int shift) {
  return shift == 0 ? value : (value + (std::uint64_t{1} << (shift - 1))) >> shift;
}

/// Of each column's values over `side` rows about each row.
Sums over_columns(const Sums& values, int side, int shift) {
  Sums sums(values.width(), values.height());
  for (int y = 0; y < values.height(); ++y) {
    const WindowReach rows(y, side / 2, values.height());
    for (int x = 0; x < values.width(); ++x) {
      std::uint64_t sum = 0;
      for (int v = rows.first; v <= rows.last; ++v) sum += values.at(x, v);
      sums.at(x, y) = rounded(sum, shift);
    }
  }
  return sums;
}

/// Of each row's values over `side` columns about each column.
Sums over_rows(const Sums& values, int side, int shift) {
  Sums sums(values.width(), values.height());
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      const WindowReach columns(x, side / 2, values.width());
      std::uint64_t sum = 0;
      for (int u = columns.first; u <= columns.last; ++u) sum += values.at(u, y);
      sums.at(x, y) = rounded(sum, shift);
    }
  }
  return sums;
}

template <typename Pixel>
Plane<std::uint16_t> reference(PlaneView<const Pixel> image, const FocusSettings& settings, const SharpnessCode& code,
                               const CodeScale& scale) {
  Sums sums(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    const auto rows = rows_about(image, y, settings.distance_px);
    for (int x = 0; x < image.width; ++x) {
      sums.at(x, y) = operator_value(settings.focus_operator, rows, x, image.width, code.operator_shift);
    }
  }
  const WindowSides sides = window_sides(settings);
  sums = over_columns(sums, sides.first, code.shift);
  sums = over_columns(sums, sides.second, code.second_shift);
  sums = over_rows(sums, sides.first, code.third_shift);
  sums = over_rows(sums, sides.second, 0);
  Plane<std::uint16_t> codes(image.width, image.height);
  const float gain = root_gain(code, gradient_shift<Pixel>(settings.focus_operator));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint64_t sum = sums.at(x, y);
      codes.at(x, y) = scale.apply(code.root ? root_code(sum, gain) : static_cast<std::uint16_t>(sum));
    }
  }
  return codes;
}

}  // namespace

Plane<std::uint16_t> sharpness_reference(const ImageView& image, const FocusSettings& settings, double gain) {
  const SharpnessCode code = sharpness_code(settings, image.format);
  const CodeScale scale(gain, settings.focus_operator, code.root);
  return image.format == PixelFormat::kMono8 ? reference(image.as<std::uint8_t>(), settings, code, scale)
                                             : reference(image.as<std::uint16_t>(), settings, code, scale);
}

}  // namespace fvd
