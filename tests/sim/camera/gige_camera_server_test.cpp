/// The simulated camera against datagrams that no well-meaning client sends.

#include "sim/camera/gige_camera_server.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "sim/camera/gvcp.hpp"

namespace fvd::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

class DarkSource final : public FrameSource {
 public:
  [[nodiscard]] int sensor_width() const override { return 64; }
  [[nodiscard]] int sensor_height() const override { return 48; }
  void render(const ExposureRequest&, std::span<std::byte> out) override { std::ranges::fill(out, std::byte{0}); }
};

class AGigeCameraServer : public testing::Test {
 protected:
  AGigeCameraServer() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(gvcp::kPort);
    ::inet_pton(AF_INET, server_.address().c_str(), &to.sin_addr);
    ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  }
  ~AGigeCameraServer() override { ::close(socket_); }

  static Bytes command(std::uint16_t code, const Bytes& payload, std::uint16_t request) {
    Bytes bytes{0x42, 0x01};
    gvcp::put16(bytes, code);
    gvcp::put16(bytes, static_cast<unsigned>(payload.size()));
    gvcp::put16(bytes, request);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return bytes;
  }
  static Bytes words(std::initializer_list<std::uint32_t> values) {
    Bytes bytes;
    for (const auto value : values) gvcp::put32(bytes, value);
    return bytes;
  }
  void send(const Bytes& bytes) { ::send(socket_, bytes.data(), bytes.size(), 0); }
  std::optional<Bytes> receive(int within_ms) {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, within_ms) <= 0) return std::nullopt;
    std::array<std::uint8_t, 2048> buffer{};
    const auto count = ::recv(socket_, buffer.data(), buffer.size(), 0);
    return Bytes(buffer.begin(), buffer.begin() + std::max<ssize_t>(0, count));
  }
  /// The status of the answer to a command; 0xFFFF without one.
  std::uint16_t status_of(std::uint16_t code, const Bytes& payload) {
    send(command(code, payload, ++request_));
    const auto reply = receive(2000);
    return reply && reply->size() >= 8 ? gvcp::get16(*reply, 0) : 0xFFFF;
  }

  DarkSource source_;
  GigeCameraServer server_{source_, {.address = free_camera_address()}};
  int socket_;
  std::uint16_t request_ = 0;
};

TEST_F(AGigeCameraServer, RefusesEachWrongRequestWithItsStatus) {
  EXPECT_EQ(status_of(0x0080, words({gvcp::reg::kVersion})), 0);
  EXPECT_EQ(status_of(0x0080, words({0x00FFFFF0})), 0x8003);
  EXPECT_EQ(status_of(0x0080, {}), 0x8002);
  EXPECT_EQ(status_of(0x0080, {1, 2, 3}), 0x8002);
  EXPECT_EQ(status_of(0x0084, words({0x10000, 0xFFFF})), 0x8002) << "more than a packet holds";
  EXPECT_EQ(status_of(0x0084, words({0x10001, 4})), 0x8005);
  EXPECT_EQ(status_of(0x0777, {}), 0x8001);
  EXPECT_EQ(status_of(0x0082, words({0x20000, 32})), 0x8006) << "not the controller";
  EXPECT_EQ(status_of(0x0082, words({gvcp::reg::kControlPrivilege, 2})), 0);
  EXPECT_EQ(status_of(0x0082, words({0x20000, 32})), 0);
  EXPECT_EQ(status_of(0x0082, words({0x20000, 65})), 0x8002) << "wider than the sensor";
  EXPECT_EQ(status_of(0x0082, words({gvcp::reg::kVersion, 1})), 0x8004);
}

TEST_F(AGigeCameraServer, SurvivesNonsenseAndStillAnswers) {
  send({});
  send({0x42});
  send(Bytes(7, 0x42));
  send({0x41, 1, 0, 0x80, 0, 4, 0, 1, 0, 0, 0, 0});    // wrong key
  send({0x42, 1, 0, 0x80, 0, 200, 0, 1, 0, 0, 0, 0});  // length beyond the packet
  send({0x42, 1, 0, 0x80, 0, 0, 0, 1, 0, 0, 0, 0});    // length short of it
  send(command(0x0040, Bytes(3, 0xFF), 1));            // resend request cut short
  send(command(0x0040, words({0x0000FFFF, 0, 0xFFFFFF}), 2));
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    Bytes bytes(random() % 600);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (bytes.size() > 1) bytes[0] = 0x42;
    send(bytes);
  }
  // Datagrams beyond a full socket buffer are lost, so a client asks again, as every GVCP client does.
  bool answered = false;
  for (int attempt = 0; attempt < 40 && !answered; ++attempt) {
    send(command(0x0080, words({gvcp::reg::kVersion}), 0x7777));
    while (auto reply = receive(250)) {
      if (reply->size() != 12 || gvcp::get16(*reply, 6) != 0x7777) continue;  // an answer to the nonsense
      EXPECT_EQ(gvcp::get16(*reply, 0), 0);
      EXPECT_EQ(gvcp::get32(*reply, 8), 0x00010002U);
      answered = true;
      break;
    }
  }
  EXPECT_TRUE(answered);
}

TEST_F(AGigeCameraServer, DoesNotRunARepeatedRequestTwice) {
  const Bytes take = command(0x0082, words({gvcp::reg::kControlPrivilege, 2}), 11);
  send(take);
  const auto first = receive(2000);
  send(take);
  const auto second = receive(2000);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
}

TEST_F(AGigeCameraServer, DoesNotShareItsPort) {
  EXPECT_THROW(GigeCameraServer(source_, {.address = server_.address()}), Error);
  EXPECT_THROW(GigeCameraServer(source_, {.address = "no address"}), Error);
}

}  // namespace
}  // namespace fvd::sim
