#pragma once

/// Numbers as bytes in either order.

#include <algorithm>
#include <cstring>
#include <string>

namespace fvd::test {

template <typename T>
std::string little(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <typename T>
std::string big(T value) {
  std::string bytes = little(value);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

template <typename T>
std::string number_bytes(T value, bool big_endian) {
  return big_endian ? big(value) : little(value);
}

template <typename T, typename... Values>
std::string little_all(Values... values) {
  return (little(static_cast<T>(values)) + ...);
}

/// The binary header of an SDF file.
struct SdfText {
  std::string magic = "bISO-1.0";
  std::uint16_t width = 3;
  std::uint16_t height = 2;
  double x_scale = 0.5e-6;
  double y_scale = 0.25e-6;
  double z_scale = 1e-9;
  std::uint8_t compression = 0;
  std::uint8_t type = 5;
  std::uint8_t check = 0;

  [[nodiscard]] std::string bytes(bool big_endian = false) const {
    return magic + std::string("maker     ") + std::string("291120261200") + std::string("291120261200") +
           number_bytes(width, big_endian) + number_bytes(height, big_endian) + number_bytes(x_scale, big_endian) +
           number_bytes(y_scale, big_endian) + number_bytes(z_scale, big_endian) + number_bytes(-1.0, big_endian) +
           little(compression) + little(type) + little(check);
  }
};

}  // namespace fvd::test
