/// How a simulated camera is found, named, and given addresses.

#include <map>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "sim/camera/gvcp.hpp"
#include "tests/sim/camera/camera_client.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/network_namespace.hpp"

namespace fvd::sim {
namespace {

using test::Bytes;
using test::GvcpClient;
using test::words;

constexpr std::uint16_t kDiscovery = 0x0002;
constexpr std::uint16_t kForceIp = 0x0004;
constexpr std::uint16_t kReadMemory = 0x0084;
constexpr std::uint16_t kWriteMemory = 0x0086;

std::string text_at(const Bytes& bytes, std::size_t at) {
  std::string text;
  for (; at < bytes.size() && bytes[at] != 0; ++at) text += static_cast<char>(bytes[at]);
  return text;
}

/// A socket of a client on 127.0.0.1 that speaks to everyone.
class Caller : public test::UdpClient {
 public:
  Caller() {
    bind();
    const int on = 1;
    ::setsockopt(socket(), SOL_SOCKET, SO_BROADCAST, &on, sizeof(on));
  }
  void call(const std::string& all, const Bytes& command) { send_to(all, gvcp::kPort, command); }
  /// The answers by serial number, until `count` have come or nothing comes any more.
  std::map<std::string, Bytes> answers(std::size_t count, int silence_ms = 5000) {
    std::map<std::string, Bytes> found;
    while (found.size() < count) {
      const auto answer = receive(silence_ms);
      if (!answer) break;
      found[text_at(*answer, 8 + gvcp::reg::kSerial)] = *answer;
    }
    return found;
  }
};

Bytes force_ip(std::uint32_t mac_low, std::uint32_t address, std::uint32_t mask, std::uint32_t gateway) {
  return words({0x0200, mac_low, 0, 0, 0, address, 0, 0, 0, mask, 0, 0, 0, gateway});
}

TEST(ADiscoverableCamera, IsFoundByBroadcastsOfBothKinds) {
  if (!fvd::test::enter_own_network()) GTEST_SKIP() << "this system does not allow a network namespace";
  test::DarkSource source;
  const GigeCameraServer one(source, {.address = "127.0.0.1", .serial = "ONE", .discoverable = true});
  const GigeCameraServer two(source, {.address = "127.0.0.2", .serial = "TWO", .name = "left", .discoverable = true});
  const GigeCameraServer hidden(source, {.address = "127.0.0.3", .serial = "HIDDEN"});
  Caller caller;
  std::uint16_t request = 0;
  for (const char* all : {"255.255.255.255", "127.255.255.255"}) {
    caller.call(all, GvcpClient::command(kDiscovery, {}, ++request));
    const auto found = caller.answers(2);
    ASSERT_EQ(found.size(), 2U) << all;
    ASSERT_TRUE(found.contains("ONE") && found.contains("TWO")) << all;
    const Bytes& answer = found.at("TWO");
    EXPECT_EQ(answer.size(), 8U + 0xF8U);
    EXPECT_EQ(text_at(answer, 8 + gvcp::reg::kUserName), "left");
    EXPECT_EQ(gvcp::get32(answer, 8 + gvcp::reg::kIpAddress), 0x7F000002U);
  }
  // Anything else that is sent to everyone is answered by nobody; the next discovery's answer is the first to come.
  caller.call("255.255.255.255", GvcpClient::command(0x0080, words({gvcp::reg::kVersion}), ++request));
  caller.call("255.255.255.255", {0x42, 1});
  caller.call("255.255.255.255", GvcpClient::command(kDiscovery, {}, ++request));
  for (const auto& [serial, answer] : caller.answers(2)) EXPECT_EQ(gvcp::get16(answer, 6), request) << serial;
}

TEST(ADiscoverableCamera, IsGivenAnAddressByItsMac) {
  if (!fvd::test::enter_own_network()) GTEST_SKIP() << "this system does not allow a network namespace";
  test::DarkSource source;
  const GigeCameraServer camera(source, {.address = "127.0.0.5", .discoverable = true});
  const GigeCameraServer other(source, {.address = "127.0.0.6", .serial = "OTHER", .discoverable = true});
  {
    GvcpClient owner("127.0.0.5");
    EXPECT_EQ(owner.write(gvcp::reg::kControlPrivilege, 2), 0);
  }
  Caller caller;
  caller.call("255.255.255.255",
              GvcpClient::command(kForceIp, force_ip(0x7F000005, 0x7F010007, 0xFFFFFF00, 0x7F010001), 1));
  const auto answer = caller.receive(5000);
  ASSERT_TRUE(answer);
  EXPECT_EQ(*answer, (Bytes{0, 0, 0, 5, 0, 0, 0, 1}));
  EXPECT_EQ(camera.address(), "127.1.0.7");
  EXPECT_EQ(other.address(), "127.0.0.6");
  GvcpClient client("127.1.0.7");
  EXPECT_EQ(client.read(gvcp::reg::kSubnetMask), 0xFFFFFF00U);
  EXPECT_EQ(client.read(gvcp::reg::kGateway), 0x7F010001U);
  EXPECT_EQ(client.write(gvcp::reg::kControlPrivilege, 2), 0) << "who had control lost it with the address";
  // An address that another has cannot be had; a command that is cut short concerns nobody.
  EXPECT_EQ(client.status_of(kForceIp, force_ip(0x7F000005, 0x7F000006, 0xFF000000, 0)), 0x8002);
  EXPECT_EQ(camera.address(), "127.1.0.7");
  client.send(GvcpClient::command(kForceIp, words({0x0200, 0x7F000005}), 99));
  EXPECT_EQ(client.read(gvcp::reg::kIpAddress), 0x7F010007U);
}

class ACameraWithAName : public test::CameraTest {};

TEST_F(ACameraWithAName, KeepsItAndItsPersistentAddressThroughAPowerCycle) {
  const std::string persistent = free_camera_address();
  in_addr address{};
  ASSERT_EQ(::inet_pton(AF_INET, persistent.c_str(), &address), 1);
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 2), 0);
  Bytes name = words({gvcp::reg::kUserName, 0, 0, 0, 0});
  name[4] = 'a';
  name[5] = 'b';
  EXPECT_EQ(client_.status_of(kWriteMemory, name), 0);
  EXPECT_EQ(client_.status_of(kWriteMemory, words({gvcp::reg::kUserName, 0, 0, 0, 0, 0})), 0x8004) << "too long";
  EXPECT_EQ(client_.write(gvcp::reg::kPersistentIpAddress, ntohl(address.s_addr)), 0);
  EXPECT_EQ(client_.write(gvcp::reg::kPersistentSubnetMask, 0xFFFF0000), 0);
  EXPECT_EQ(client_.write(gvcp::reg::kIpConfigCurrent, 8), 0x8002);
  EXPECT_EQ(client_.write(gvcp::reg::kIpConfigCurrent, 1), 0);
  EXPECT_EQ(client_.read(gvcp::reg::kIpConfigCurrent), 5U) << "link-local addresses cannot be switched off";
  EXPECT_NE(server_.address(), persistent) << "not before it looks for an address";
  server_.faults().add(
      {.fault = CameraFault::kRestart, .on = CameraEvent::kCommand, .delay = std::chrono::milliseconds(1)});
  client_.send(GvcpClient::command(0x0080, words({gvcp::reg::kVersion}), 0x3000));
  GvcpClient again(persistent);
  Bytes reply;
  const HostTime deadline = HostClock::now() + std::chrono::seconds(20);
  while (reply.empty() && HostClock::now() < deadline) {  // nobody is there before the camera has restarted
    again.send(GvcpClient::command(kReadMemory, words({gvcp::reg::kUserName, 16}), 0x3001));
    reply = again.receive(100).value_or(Bytes{});
  }
  ASSERT_EQ(reply.size(), 8U + 4U + 16U);
  EXPECT_EQ(text_at(reply, 12), "ab");
  EXPECT_EQ(again.read(gvcp::reg::kSubnetMask), 0xFFFF0000U);
}

TEST(ACameraWithALongName, IsRefused) {
  test::DarkSource source;
  const std::string address = free_camera_address();
  for (const GigeCameraOptions& options : {GigeCameraOptions{.address = address, .serial = "0123456789ABCDEF"},
                                           GigeCameraOptions{.address = address, .name = "0123456789ABCDEF"}}) {
    fvd::test::expect_error(ErrorCode::kBadConfig, {"15 characters"}, [&] { GigeCameraServer(source, options); });
  }
}

}  // namespace
}  // namespace fvd::sim
