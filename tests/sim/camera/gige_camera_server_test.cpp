/// The simulated camera against datagrams that no well-meaning client sends.

#include "sim/camera/gige_camera_server.hpp"

#include <random>

#include "core/base/error.hpp"
#include "tests/sim/camera/camera_client.hpp"

namespace fvd::sim {
namespace {

using test::Bytes;
using test::GvcpClient;
using test::words;

constexpr std::uint16_t kWriteRegister = 0x0082;

class AGigeCameraServer : public test::CameraTest {};

TEST_F(AGigeCameraServer, RefusesEachWrongRequestWithItsStatus) {
  EXPECT_EQ(client_.status_of(0x0080, words({gvcp::reg::kVersion})), 0);
  EXPECT_EQ(client_.status_of(0x0080, words({0x00FFFFF0})), 0x8003);
  EXPECT_EQ(client_.status_of(0x0080, {}), 0x8002);
  EXPECT_EQ(client_.status_of(0x0080, {1, 2, 3}), 0x8002);
  EXPECT_EQ(client_.status_of(0x0084, words({0x10000, 0xFFFF})), 0x8002) << "more than a packet holds";
  EXPECT_EQ(client_.status_of(0x0084, words({0x10001, 4})), 0x8005);
  EXPECT_EQ(client_.status_of(0x0777, {}), 0x8001);
  EXPECT_EQ(client_.write(feature::kWidth, 32), 0x8006) << "not the controller";
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 2), 0);
  EXPECT_EQ(client_.write(feature::kWidth, 32), 0);
  EXPECT_EQ(client_.write(feature::kWidth, 65), 0x8002) << "wider than the sensor";
  EXPECT_EQ(client_.write(gvcp::reg::kVersion, 1), 0x8004);
}

TEST_F(AGigeCameraServer, RefusesValuesBeyondWhatItDescribes) {
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 2), 0);
  EXPECT_EQ(client_.write(feature::kOffsetX, 1), 0x8002) << "the image would reach beyond the sensor";
  EXPECT_EQ(client_.write(feature::kWidth, 60), 0);
  EXPECT_EQ(client_.write(feature::kOffsetX, 4), 0);
  EXPECT_EQ(client_.write(feature::kOffsetX, 5), 0x8002);
  EXPECT_EQ(client_.write(feature::kOffsetX, 0xFFFFFFFF), 0x8002);
  EXPECT_EQ(client_.write(feature::kWidth, 61), 0x8002) << "with the offset there is";
  EXPECT_EQ(client_.write(gvcp::reg::kStreamPacketSize, 1498), 0x8002) << "not a multiple of 4";
  EXPECT_EQ(client_.write(gvcp::reg::kStreamPacketSize, 572), 0x8002);
  EXPECT_EQ(client_.write(gvcp::reg::kStreamPacketDelay, 1000001), 0x8002);
  EXPECT_EQ(client_.write(gvcp::reg::kStreamPacketDelay, 1000000), 0);
}

TEST(AGigeCameraServerWithAnIncrement, TakesWidthsOnItsGridOnly) {
  test::DarkSource source;
  const GigeCameraServer server(source, {.address = free_camera_address(), .width_increment = 16});
  GvcpClient client(server.address());
  EXPECT_EQ(client.write(gvcp::reg::kControlPrivilege, 2), 0);
  EXPECT_EQ(client.write(feature::kWidth, 24), 0x8002);
  EXPECT_EQ(client.write(feature::kWidth, 8), 0x8002);
  EXPECT_EQ(client.write(feature::kWidth, 32), 0);
  EXPECT_EQ(client.write(feature::kHeight, 7), 0) << "rows have no grid";
}

TEST_F(AGigeCameraServer, TellsHowFarARefusedWriteCame) {
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 2), 0);
  const Bytes reply =
      client_.ask(kWriteRegister, words({feature::kWidth, 32, feature::kHeight, 16, gvcp::reg::kVersion, 1}));
  ASSERT_EQ(reply.size(), 12U);
  EXPECT_EQ(gvcp::get16(reply, 0), 0x8004);
  EXPECT_EQ(gvcp::get16(reply, 10), 2) << "two were written";
  EXPECT_EQ(client_.read(feature::kHeight), 16U);
}

TEST_F(AGigeCameraServer, GivesControlForTheValuesThatMeanIt) {
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 8), 0x8002);
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 0x10002), 0x8002) << "a switchover key without switchover";
  EXPECT_EQ(client_.read(gvcp::reg::kControlPrivilege), 0U);
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 2), 0);
  EXPECT_EQ(client_.read(gvcp::reg::kPrimaryAddress), INADDR_LOOPBACK);
  EXPECT_NE(client_.read(gvcp::reg::kPrimaryPort), 0U);
  GvcpClient other(server_.address());
  EXPECT_EQ(other.write(gvcp::reg::kControlPrivilege, 2), 0x8006);
  EXPECT_EQ(other.status_of(0x0080, words({feature::kWidth})), 0) << "control lets others read";
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 1), 0);
  EXPECT_EQ(other.status_of(0x0080, words({feature::kWidth})), 0x8006) << "exclusive access does not";
  EXPECT_EQ(other.status_of(0x0084, words({0x10000, 4})), 0x8006);
  EXPECT_EQ(other.read(gvcp::reg::kControlPrivilege), 1U);
  EXPECT_EQ(client_.write(gvcp::reg::kControlPrivilege, 0), 0);
  EXPECT_EQ(other.write(gvcp::reg::kControlPrivilege, 2), 0);
}

TEST_F(AGigeCameraServer, SurvivesNonsenseAndStillAnswers) {
  client_.send({});
  client_.send({0x42});
  client_.send(Bytes(7, 0x42));
  client_.send({0x41, 1, 0, 0x80, 0, 4, 0, 1, 0, 0, 0, 0});      // wrong key
  client_.send({0x42, 1, 0, 0x80, 0, 200, 0, 1, 0, 0, 0, 0});    // length beyond the packet
  client_.send({0x42, 1, 0, 0x80, 0, 0, 0, 1, 0, 0, 0, 0});      // length short of it
  client_.send(GvcpClient::command(0x0040, Bytes(3, 0xFF), 1));  // resend request cut short
  client_.send(GvcpClient::command(0x0040, words({0x0000FFFF, 0, 0xFFFFFF}), 2));
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    Bytes bytes(random() % 600);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (bytes.size() > 1) bytes[0] = 0x42;
    client_.send(bytes);
  }
  // Datagrams beyond a full socket buffer are lost, so a client asks again, as every GVCP client does.
  bool answered = false;
  for (int attempt = 0; attempt < 40 && !answered; ++attempt) {
    client_.send(GvcpClient::command(0x0080, words({gvcp::reg::kVersion}), 0x7777));
    while (auto reply = client_.receive(250)) {
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
  open_stream();
  start(true);
  const Bytes trigger = GvcpClient::command(kWriteRegister, words({feature::kTriggerSoftware, 1}), 0x4321);
  client_.send(trigger);
  const auto first = client_.receive(5000);
  GvcpClient other(server_.address());
  EXPECT_EQ(other.read(gvcp::reg::kVersion), 0x00010002U) << "the question of another comes between";
  EXPECT_EQ(receive_frame().size(), 5U);
  client_.send(trigger);
  const auto second = client_.receive(5000);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
  // The number alone makes no repetition.
  client_.send(GvcpClient::command(kWriteRegister, words({gvcp::reg::kHeartbeatTimeout, 4000}), 0x4321));
  ASSERT_TRUE(client_.receive(5000).has_value());
  EXPECT_EQ(client_.read(gvcp::reg::kHeartbeatTimeout), 4000U);
  EXPECT_EQ(gvcp::get16(trigger_frame().at(0), 2), 2) << "one frame was exposed before this one";
}

TEST_F(AGigeCameraServer, DoesNotShareItsPort) {
  EXPECT_THROW(GigeCameraServer(source_, {.address = server_.address()}), Error);
  EXPECT_THROW(GigeCameraServer(source_, {.address = "no address"}), Error);
}

}  // namespace
}  // namespace fvd::sim
