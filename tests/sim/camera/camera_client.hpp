#pragma once

/// A simulated camera, and the bare datagrams of a client: commands, and a socket that the stream comes to.

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "gtest/gtest.h"
#include "sim/camera/camera_registers.hpp"
#include "sim/camera/gige_camera_server.hpp"
#include "sim/camera/gvcp.hpp"

namespace fvd::sim::test {

using Bytes = std::vector<std::uint8_t>;

class DarkSource final : public FrameSource {
 public:
  [[nodiscard]] int sensor_width() const override { return 64; }
  [[nodiscard]] int sensor_height() const override { return 48; }
  void render(const ExposureRequest&, std::span<std::byte> out) override { std::ranges::fill(out, std::byte{0}); }
};

inline Bytes words(std::initializer_list<std::uint32_t> values) {
  Bytes bytes;
  for (const auto value : values) gvcp::put32(bytes, value);
  return bytes;
}

/// A UDP socket; every answer is waited for generously.
class UdpClient {
 public:
  UdpClient() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~UdpClient() { ::close(socket_); }
  UdpClient(const UdpClient&) = delete;
  UdpClient& operator=(const UdpClient&) = delete;

  void connect(const std::string& address, int port = gvcp::kPort) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, address.c_str(), &to.sin_addr);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
  }
  /// Binds any free port of 127.0.0.1 and returns it.
  std::uint16_t bind() {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof(own);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof(own)), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &length), 0);
    return ntohs(own.sin_port);
  }
  void send(const Bytes& bytes) const { ::send(socket_, bytes.data(), bytes.size(), 0); }
  [[nodiscard]] std::optional<Bytes> receive(int within_ms) const {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, within_ms) <= 0) return std::nullopt;
    std::array<std::uint8_t, 2048> buffer{};
    const auto count = ::recv(socket_, buffer.data(), buffer.size(), 0);
    return Bytes(buffer.begin(), buffer.begin() + std::max<ssize_t>(0, count));
  }

  void send_to(const std::string& address, int port, const Bytes& bytes) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    ::inet_pton(AF_INET, address.c_str(), &to.sin_addr);
    EXPECT_EQ(::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof(to)),
              static_cast<ssize_t>(bytes.size()));
  }

 protected:
  [[nodiscard]] int socket() const { return socket_; }

 private:
  int socket_;
};

/// Speaks GVCP to a camera.
class GvcpClient : public UdpClient {
 public:
  explicit GvcpClient(const std::string& address) { connect(address); }

  static Bytes command(std::uint16_t code, const Bytes& payload, std::uint16_t request) {
    Bytes bytes{0x42, 0x01};
    gvcp::put16(bytes, code);
    gvcp::put16(bytes, static_cast<unsigned>(payload.size()));
    gvcp::put16(bytes, request);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return bytes;
  }
  /// The whole acknowledge of a command; empty without one.
  Bytes ask(std::uint16_t code, const Bytes& payload) {
    send(command(code, payload, ++request_));
    return receive(5000).value_or(Bytes{});
  }
  /// The status of the answer to a command; 0xFFFF without one.
  std::uint16_t status_of(std::uint16_t code, const Bytes& payload) {
    const Bytes reply = ask(code, payload);
    return reply.size() >= 8 ? gvcp::get16(reply, 0) : 0xFFFF;
  }
  std::uint16_t write(std::uint32_t address, std::uint32_t value) { return status_of(0x0082, words({address, value})); }
  std::uint32_t read(std::uint32_t address) {
    const Bytes reply = ask(0x0080, words({address}));
    EXPECT_EQ(reply.size(), 12U) << "register " << address;
    return reply.size() == 12 ? gvcp::get32(reply, 8) : 0;
  }

 private:
  std::uint16_t request_ = 0;
};

/// A camera of 64 x 48 pixels, a client of it, and the socket of its stream.
class CameraTest : public testing::Test {
 protected:
  /// Takes control and directs the stream here; exposures are short.
  void open_stream(std::uint32_t packet_size = 1500) {
    EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 2), 0);
    EXPECT_EQ(client_.write(gvcp::reg::kStreamAddress, INADDR_LOOPBACK), 0);
    EXPECT_EQ(client_.write(gvcp::reg::kStreamPort, stream_.bind()), 0);
    EXPECT_EQ(client_.write(gvcp::reg::kStreamPacketSize, packet_size), 0);
  }
  void start(bool triggered) {
    EXPECT_EQ(client_.write(feature::kTriggerMode, triggered ? 1 : 0), 0);
    EXPECT_EQ(client_.write(feature::kAcquisitionStart, 1), 0);
  }
  /// The packets of one frame, leader and trailer included, in the order in which they came.
  std::vector<Bytes> receive_frame() {
    std::vector<Bytes> packets;
    while (packets.empty() || type_of(packets.back()) != 2) {
      const auto packet = stream_.receive(5000);
      if (!packet) break;
      packets.push_back(*packet);
    }
    EXPECT_FALSE(packets.empty());
    return packets;
  }
  std::vector<Bytes> trigger_frame() {
    EXPECT_EQ(client_.write(feature::kTriggerSoftware, 1), 0);
    return receive_frame();
  }
  static int type_of(const Bytes& packet) { return packet.size() < 8 ? 0 : packet[4] & 0x0F; }
  static std::uint64_t time_of(const Bytes& leader) {
    return (std::uint64_t{gvcp::get32(leader, 12)} << 32U) | gvcp::get32(leader, 16);
  }

  DarkSource source_;
  GigeCameraServer server_{source_, {.address = free_camera_address()}};
  GvcpClient client_{server_.address()};
  UdpClient stream_;
};

}  // namespace fvd::sim::test
