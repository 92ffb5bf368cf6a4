#pragma once

/// A man in the middle of a Modbus TCP line who bends single fields of what the drive answers, as gateways and devices
/// in the field do.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "sim/base/file_descriptor.hpp"

namespace fvd::test {

using LineBytes = std::vector<std::uint8_t>;

inline sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

/// A listener on a free port; who takes it closes it. address: where. Throws if there is none.
inline int listen_on_loopback(int queue, sockaddr_in& address) {
  address = loopback(0);
  socklen_t length = sizeof(address);
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::bind(listener, any, length) != 0 || ::listen(listener, queue) != 0 ||
      ::getsockname(listener, any, &length) != 0) {
    throw std::runtime_error("no port on 127.0.0.1");
  }
  return listener;
}

/// False once a stop is requested before anything came.
inline bool readable(int socket, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    pollfd waiting{socket, POLLIN, 0};
    if (::poll(&waiting, 1, 20) > 0) return true;
  }
  return false;
}

/// What becomes of an answer; header first.
struct LineBend {
  std::function<void(LineBytes& answer)> answer = nullptr;  ///< changes it
  LineBytes trailing{};                                     ///< sent behind it
  bool closes = false;                                      ///< the connection ends after it
};

/// Serves one client at a time on a port of its own. context: any thread.
class BentLine {
 public:
  /// upstream_port: of the drive, on 127.0.0.1.
  BentLine(int upstream_port, LineBend bend)
      : upstream_port_(upstream_port), bend_(std::move(bend)), listener_(listen_on_loopback(8, address_)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }

  [[nodiscard]] int port() const noexcept { return ntohs(address_.sin_port); }
  [[nodiscard]] int answers() const noexcept { return answers_; }
  [[nodiscard]] int connections() const noexcept { return connections_; }
  /// Off: the line is straight.
  void set_bent(bool bent) noexcept { bent_ = bent; }

 private:
  static bool read_all(int socket, std::span<std::uint8_t> bytes, const std::stop_token& stop) {
    for (std::size_t have = 0; have < bytes.size();) {
      if (!readable(socket, stop)) return false;
      const auto count = ::recv(socket, bytes.data() + have, bytes.size() - have, 0);
      if (count <= 0) return false;
      have += static_cast<std::size_t>(count);
    }
    return true;
  }

  static bool read_frame(int socket, LineBytes& frame, const std::stop_token& stop) {
    frame.assign(6, 0);
    if (!read_all(socket, frame, stop)) return false;
    const std::size_t length = std::size_t{frame[4]} << 8U | frame[5];
    frame.resize(6 + length);
    return read_all(socket, std::span(frame).subspan(6), stop);
  }

  static bool send_all(int socket, const LineBytes& bytes) {
    return ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  void serve(const std::stop_token& stop) {
    while (readable(listener_.get(), stop)) {
      const sim::FileDescriptor client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      const sim::FileDescriptor drive(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
      const sockaddr_in address = loopback(upstream_port_);
      if (::connect(drive.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) continue;
      ++connections_;
      while (pass_one(client.get(), drive.get(), stop)) {
      }
    }
  }

  bool pass_one(int client, int drive, const std::stop_token& stop) {
    LineBytes frame;
    if (!read_frame(client, frame, stop) || !send_all(drive, frame) || !read_frame(drive, frame, stop)) return false;
    ++answers_;
    if (!bent_) return send_all(client, frame);
    if (bend_.answer) bend_.answer(frame);
    frame.insert(frame.end(), bend_.trailing.begin(), bend_.trailing.end());
    return send_all(client, frame) && !bend_.closes;
  }

  const int upstream_port_;
  const LineBend bend_;
  sockaddr_in address_{};
  const sim::FileDescriptor listener_;
  std::atomic<bool> bent_{true};
  std::atomic<int> answers_{0};
  std::atomic<int> connections_{0};
  std::jthread thread_;  // last
};

}  // namespace fvd::test
