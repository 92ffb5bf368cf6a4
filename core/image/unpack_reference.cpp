#include <cstdint>
#include <cstring>

#include "core/image/unpack.hpp"

namespace fvd {

namespace {

unsigned byte_at(const WireImage& image, std::size_t i) { return static_cast<unsigned>(image.bytes[i]); }

/// The value of the i-th pixel on the wire.
unsigned value_at(const WireImage& image, std::size_t i) {
  switch (image.format) {
    case SensorFormat::kMono10p:
    case SensorFormat::kMono12p: {
      const auto bits = static_cast<std::size_t>(sensor_format_info(image.format).bits);
      unsigned value = 0;
      for (std::size_t bit = 0; bit < bits; ++bit) {
        const std::size_t at = i * bits + bit;
        value |= ((byte_at(image, at / 8) >> (at % 8)) & 1U) << bit;
      }
      return value;
    }
    case SensorFormat::kMono12Packed: {
      const std::size_t pair = i / 2 * 3;
      const unsigned low = byte_at(image, pair + 1);
      return i % 2 == 0 ? (byte_at(image, pair) << 4U) | (low & 0xFU) : (byte_at(image, pair + 2) << 4U) | (low >> 4U);
    }
    default:
      break;
  }
  if (sensor_format_info(image.format).bits_per_pixel == 8) return byte_at(image, i);
  const unsigned wide = byte_at(image, 2 * i) | (byte_at(image, 2 * i + 1) << 8U);
  return image.format == SensorFormat::kMono16 && image.significant_bits != 0
             ? wide >> (16U - static_cast<unsigned>(image.significant_bits))
             : wide;
}

/// Mirrored at the border, which is not repeated.
std::size_t mirrored(int at, int size) {
  if (at < 0) return static_cast<std::size_t>(-at);
  return static_cast<std::size_t>(at < size ? at : 2 * size - 2 - at);
}

unsigned demosaicked(const WireImage& image, int x, int y) {
  const auto at = [&](int column, int row) {
    return value_at(
        image, mirrored(row, image.height) * static_cast<std::size_t>(image.width) + mirrored(column, image.width));
  };
  if (image.bayer == BayerUse::kLuminance) {
    return (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1) + 2) / 4;
  }
  const auto order = sensor_format_info(image.format).name.substr(5, 2);
  const bool green_first = order == "GR" || order == "GB";
  const bool green = ((x + y) % 2 == 0) == green_first;
  return green ? at(x, y) : (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1) + 2) / 4;
}

}  // namespace

void unpack_reference(const WireImage& image, std::span<std::byte> slice) {
  const bool narrow = bytes_per_pixel(slice_format(image.format, image.significant_bits)) == 1;
  const bool mosaic = sensor_format_info(image.format).bayer;
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++i) {
      const unsigned value = mosaic ? demosaicked(image, x, y) : value_at(image, i);
      if (narrow) {
        slice[i] = static_cast<std::byte>(value);
      } else {
        const auto wide = static_cast<std::uint16_t>(value);
        std::memcpy(&slice[2 * i], &wide, 2);
      }
    }
  }
}

}  // namespace fvd
