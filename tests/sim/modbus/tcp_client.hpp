#pragma once

/// Raw bytes on a connection to this machine, with deadlines.

#include <chrono>
#include <span>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "sim/base/file_descriptor.hpp"
#include "sim/modbus/modbus_responder.hpp"

namespace fvd::sim::test {

class TcpClient {
 public:
  explicit TcpClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }

  [[nodiscard]] bool is_open() const { return is_open_; }  ///< until the server has closed

  bool send(std::span<const std::uint8_t> bytes) {
    return ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  /// As many bytes as come before the deadline or the end, `count` at most.
  ModbusBytes receive(std::size_t count, std::chrono::milliseconds within = std::chrono::seconds(5)) {
    const auto deadline = std::chrono::steady_clock::now() + within;
    ModbusBytes bytes;
    while (bytes.size() < count) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      pollfd waiting{socket_.get(), POLLIN, 0};
      if (left.count() < 0 || ::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) break;
      ModbusBytes chunk(count - bytes.size());
      const auto read = ::recv(socket_.get(), chunk.data(), chunk.size(), 0);
      if (read <= 0) {
        is_open_ = false;
        break;
      }
      bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + read);
    }
    return bytes;
  }

  /// Transaction, protocol, length, unit and PDU.
  static ModbusBytes frame(int transaction, int unit, std::span<const std::uint8_t> pdu) {
    const auto low = [](std::size_t value) { return static_cast<std::uint8_t>(value & 0xFFU); };
    const auto number = static_cast<std::size_t>(transaction);
    ModbusBytes bytes{low(number >> 8U),
                      low(number),
                      0,
                      0,
                      low((pdu.size() + 1) >> 8U),
                      low(pdu.size() + 1),
                      static_cast<std::uint8_t>(unit)};
    for (const auto byte : pdu) bytes.push_back(byte);
    return bytes;
  }

 private:
  FileDescriptor socket_;
  bool is_open_ = false;
};

}  // namespace fvd::sim::test
