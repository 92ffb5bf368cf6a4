#pragma once

/// Raw bytes on a serial port, with deadlines.

#include <chrono>
#include <filesystem>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>

#include "sim/base/file_descriptor.hpp"
#include "sim/modbus/modbus_responder.hpp"

namespace fvd::sim::test {

class SerialClient {
 public:
  explicit SerialClient(const std::filesystem::path& path)
      : port_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    termios settings{};
    ::tcgetattr(port_.get(), &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(port_.get(), TCSANOW, &settings);
    ::ioctl(port_.get(), TIOCEXCL);
  }

  [[nodiscard]] bool is_open() const { return port_.get() >= 0; }

  bool send(std::span<const std::uint8_t> bytes) {
    return ::write(port_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }

  /// As many bytes as come before the deadline, `count` at most.
  ModbusBytes receive(std::size_t count, std::chrono::milliseconds within = std::chrono::seconds(5)) {
    const auto deadline = std::chrono::steady_clock::now() + within;
    ModbusBytes bytes;
    while (bytes.size() < count) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      pollfd waiting{port_.get(), POLLIN, 0};
      if (left.count() < 0 || ::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) break;
      ModbusBytes chunk(count - bytes.size());
      const auto read = ::read(port_.get(), chunk.data(), chunk.size());
      if (read <= 0) break;
      bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + read);
    }
    return bytes;
  }

  /// Unit, PDU and checksum.
  static ModbusBytes frame(int unit, std::span<const std::uint8_t> pdu) {
    ModbusBytes bytes;
    bytes.reserve(pdu.size() + 3);
    bytes.push_back(static_cast<std::uint8_t>(unit));
    for (const auto byte : pdu) bytes.push_back(byte);
    const unsigned crc = modbus_crc(bytes);
    bytes.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
    return bytes;
  }

 private:
  FileDescriptor port_;
};

}  // namespace fvd::sim::test
