#include "sim/camera/sensor_readout.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace fvd::sim {

namespace {

constexpr double kRed = 0.8;
constexpr double kBlue = 0.6;

unsigned grey(std::span<const std::byte> pixels, std::size_t i, bool wide) {
  if (!wide) return static_cast<unsigned>(pixels[i]);
  std::uint16_t value = 0;
  std::memcpy(&value, &pixels[2 * i], 2);
  return value;
}

/// Bits from the least significant on, as PFNC's "p" formats have it.
void pack_lsb_first(std::span<const std::byte> pixels, unsigned bits, std::span<std::byte> wire) {
  std::uint32_t held = 0;
  unsigned count = 0;
  std::size_t out = 0;
  for (std::size_t i = 0; i < pixels.size() / 2; ++i) {
    held |= grey(pixels, i, true) << count;
    for (count += bits; count >= 8; count -= 8) {
      wire[out++] = static_cast<std::byte>(held & 0xFFU);
      held >>= 8U;
    }
  }
  if (count > 0) wire[out] = static_cast<std::byte>(held & 0xFFU);
}

/// GigE Vision's own: upper 8 bits of the first, both lower halves, upper 8 bits of the second.
void pack_gige_12(std::span<const std::byte> pixels, std::span<std::byte> wire) {
  const std::size_t count = pixels.size() / 2;
  for (std::size_t i = 0; i < count; i += 2) {
    const unsigned first = grey(pixels, i, true);
    const unsigned second = i + 1 < count ? grey(pixels, i + 1, true) : 0;
    const std::size_t out = i / 2 * 3;
    wire[out] = static_cast<std::byte>(first >> 4U);
    wire[out + 1] = static_cast<std::byte>((first & 0xFU) | ((second & 0xFU) << 4U));
    if (out + 2 < wire.size()) wire[out + 2] = static_cast<std::byte>(second >> 4U);
  }
}

/// Gain of the colour at a place of the sensor: phase tells where red is.
double colour_gain(int x, int y, int red_x, int red_y) {
  const bool red_column = (x & 1) == red_x;
  const bool red_row = (y & 1) == red_y;
  if (red_column && red_row) return kRed;
  return red_column || red_row ? 1.0 : kBlue;
}

void mosaic(SensorFormat format, std::span<const std::byte> pixels, int width, int offset_x, int offset_y,
            std::span<std::byte> wire) {
  const SensorFormatInfo info = sensor_format_info(format);
  const bool wide = info.bits > 8;
  const std::string_view order = info.name.substr(5, 2);  // "RG", "GR", "GB" or "BG"
  const int red_x = order == "RG" || order == "GB" ? 0 : 1;
  const int red_y = order == "RG" || order == "GR" ? 0 : 1;
  const std::size_t count = pixels.size() / (wide ? 2 : 1);
  for (std::size_t i = 0; i < count; ++i) {
    const int x = static_cast<int>(i % static_cast<std::size_t>(width)) + offset_x;
    const int y = static_cast<int>(i / static_cast<std::size_t>(width)) + offset_y;
    const double value = grey(pixels, i, wide) * colour_gain(x, y, red_x, red_y);
    const auto level = static_cast<std::uint16_t>(std::lround(value));
    if (wide) {
      std::memcpy(&wire[2 * i], &level, 2);
    } else {
      wire[i] = static_cast<std::byte>(level);
    }
  }
}

}  // namespace

bool needs_readout(SensorFormat format) {
  const SensorFormatInfo info = sensor_format_info(format);
  return info.bayer || info.bits_per_pixel % 8 != 0;
}

void read_out(SensorFormat format, std::span<const std::byte> pixels, int width, int offset_x, int offset_y,
              std::span<std::byte> wire) {
  switch (format) {
    case SensorFormat::kMono10p:
      return pack_lsb_first(pixels, 10, wire);
    case SensorFormat::kMono12p:
      return pack_lsb_first(pixels, 12, wire);
    case SensorFormat::kMono12Packed:
      return pack_gige_12(pixels, wire);
    default:
      break;
  }
  if (sensor_format_info(format).bayer) return mosaic(format, pixels, width, offset_x, offset_y, wire);
  std::memcpy(wire.data(), pixels.data(), wire.size());
}

}  // namespace fvd::sim
