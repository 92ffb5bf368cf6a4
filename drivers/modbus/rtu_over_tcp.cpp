#include "drivers/modbus/rtu_over_tcp.hpp"

#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace fvd {

namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

/// CRC-16 of Modbus over Serial Line V1.02, 6.2.2. Over a frame with its checksum it is 0.
std::uint16_t checksum(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U;
  }
  return static_cast<std::uint16_t>(crc);
}

class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  [[nodiscard]] int get() const noexcept { return fd_; }
  [[nodiscard]] bool ready(short events, SteadyClock::time_point deadline) const {
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - SteadyClock::now()).count();
    pollfd waiting{fd_, events, 0};
    return left > 0 && ::poll(&waiting, 1, static_cast<int>(left)) > 0;
  }

 private:
  int fd_;
};

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Addresses addresses_of(const ModbusTcpEndpoint& endpoint) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(endpoint.port);
  if (::getaddrinfo(endpoint.host.c_str(), port.c_str(), &hints, &found) != 0) found = nullptr;
  return {found, &::freeaddrinfo};
}

}  // namespace

bool answers_serial_frames(const ModbusTcpEndpoint& endpoint, int unit, milliseconds timeout) {
  constexpr std::size_t kShortestFrame = 5;  // of an exception
  const Addresses addresses = addresses_of(endpoint);
  if (!addresses) return false;
  const Socket socket(::socket(addresses->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const bool connects = ::connect(socket.get(), addresses->ai_addr, addresses->ai_addrlen) == 0 || errno == EINPROGRESS;
  if (!connects || !socket.ready(POLLOUT, SteadyClock::now() + timeout)) return false;
  std::array<std::uint8_t, 8> request{static_cast<std::uint8_t>(unit), 3, 0, 0, 0, 1, 0, 0};
  const std::uint16_t crc = checksum(std::span(request).first(6));
  request[6] = static_cast<std::uint8_t>(crc & 0xFFU);
  request[7] = static_cast<std::uint8_t>(crc >> 8U);
  if (::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size())) {
    return false;
  }
  const auto deadline = SteadyClock::now() + timeout;
  std::array<std::uint8_t, 64> answer{};
  for (std::size_t length = 0; length < answer.size() && socket.ready(POLLIN, deadline);) {
    const auto count = ::recv(socket.get(), answer.data() + length, answer.size() - length, 0);
    if (count <= 0) return false;
    length += static_cast<std::size_t>(count);
    const auto frame = std::span(answer).first(length);
    if (length >= kShortestFrame && frame[0] == unit && checksum(frame) == 0) return true;
  }
  return false;
}

}  // namespace fvd
