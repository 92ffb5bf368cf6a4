#include "sim/modbus/modbus_rtu_server.hpp"

#include "gtest/gtest.h"
#include "tests/sim/modbus/modbus_requests.hpp"
#include "tests/sim/modbus/serial_client.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::sim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::SerialClient;
using test::short_request;
using test::write_request;

/// Long against what a loaded machine delays two writes of one client by.
constexpr LineTiming kSlowClientTiming{.frame_silence = milliseconds(100)};

class AnRtuServer : public testing::Test {
 protected:
  AnRtuServer() { bank_.count_up(); }

  static ModbusBytes request(int unit = 1) { return SerialClient::frame(unit, short_request(3, 2, 1)); }
  static ModbusBytes answer() { return SerialClient::frame(1, ModbusBytes{3, 2, 0x01, 0x02}); }

  /// A server that a loaded machine held up takes a request for the end of the garbage before it; then silence, again.
  static ModbusBytes answer_in_the_end(SerialClient& client) {
    for (int attempt = 0; attempt < 50; ++attempt) {
      client.send(request());
      const ModbusBytes reply = client.receive(7, milliseconds(100));
      if (!reply.empty()) return reply;
    }
    return {};
  }

  test::PlainBank bank_;
};

TEST_F(AnRtuServer, AnswersARequest) {
  ModbusRtuServer server(bank_, {});
  SerialClient client(server.path());
  ASSERT_TRUE(client.is_open());
  client.send(request());
  EXPECT_EQ(client.receive(7), answer());
  client.send(SerialClient::frame(1, write_request(5, {7, 8})));
  EXPECT_EQ(client.receive(8), SerialClient::frame(1, short_request(16, 5, 2)));
  EXPECT_EQ(bank_.at(6), 8);
  client.send(SerialClient::frame(1, ModbusBytes{23, 0, 2, 0, 1, 0, 2, 0, 1, 2, 0, 9}));
  EXPECT_EQ(client.receive(7), SerialClient::frame(1, ModbusBytes{23, 2, 0, 9}));
  EXPECT_EQ(server.requests(), 3U);
}

TEST_F(AnRtuServer, AnswersExceptions) {
  ModbusRtuServer server(bank_, {});
  SerialClient client(server.path());
  client.send(SerialClient::frame(1, short_request(3, 200, 1)));
  EXPECT_EQ(client.receive(5), SerialClient::frame(1, ModbusBytes{0x83, 2}));
}

TEST_F(AnRtuServer, EndsAFrameOfAnUnknownFunctionBySilence) {
  ModbusRtuServer server(bank_, {.timing = kSlowClientTiming});
  SerialClient client(server.path());
  client.send(SerialClient::frame(1, ModbusBytes{44, 14, 1, 0}));
  EXPECT_EQ(client.receive(5), SerialClient::frame(1, ModbusBytes{0xAC, 1}));
}

TEST_F(AnRtuServer, PutsSplitFramesTogether) {
  ModbusRtuServer server(bank_, {.timing = kSlowClientTiming});
  SerialClient client(server.path());
  for (const auto byte : request()) client.send(std::span(&byte, 1));
  EXPECT_EQ(client.receive(7), answer());
}

TEST_F(AnRtuServer, AnswersFramesWithoutSilenceBetweenThem) {
  ModbusRtuServer server(bank_, {.timing = kSlowClientTiming});
  SerialClient client(server.path());
  ModbusBytes two = request();
  const ModbusBytes second = SerialClient::frame(1, short_request(3, 3, 1));
  two.insert(two.end(), second.begin(), second.end());
  client.send(two);
  EXPECT_EQ(client.receive(7), answer());
  EXPECT_EQ(client.receive(7), SerialClient::frame(1, ModbusBytes{3, 2, 0x01, 0x03}));
}

TEST_F(AnRtuServer, IsSilentToAWrongChecksumAndFindsBack) {
  ModbusRtuServer server(bank_, {});
  SerialClient client(server.path());
  ModbusBytes wrong = request();
  wrong.back() = static_cast<std::uint8_t>(wrong.back() ^ 1U);
  client.send(wrong);
  EXPECT_TRUE(client.receive(1, milliseconds(30)).empty());
  EXPECT_EQ(answer_in_the_end(client), answer());
  EXPECT_EQ(server.requests(), 1U);
}

TEST_F(AnRtuServer, FindsBackFromGarbageAfterSilence) {
  ModbusRtuServer server(bank_, {});
  SerialClient client(server.path());
  for (const auto& garbage :
       {ModbusBytes{1, 3, 0}, ModbusBytes{0xFF}, ModbusBytes(300, 0x55), ModbusBytes{1, 16, 0, 0}}) {
    client.send(garbage);
    EXPECT_TRUE(client.receive(1, milliseconds(30)).empty());
    EXPECT_EQ(answer_in_the_end(client), answer());
  }
}

TEST_F(AnRtuServer, AnswersOnlyToItsUnitAndObeysBroadcasts) {
  ModbusRtuServer server(bank_, {.unit = 5});
  SerialClient client(server.path());
  client.send(request(1));
  EXPECT_TRUE(client.receive(1, milliseconds(30)).empty());
  client.send(SerialClient::frame(0, short_request(6, 2, 77)));
  EXPECT_TRUE(client.receive(1, milliseconds(30)).empty());
  client.send(request(5));
  EXPECT_EQ(client.receive(7), SerialClient::frame(5, ModbusBytes{3, 2, 0, 77}));
}

TEST_F(AnRtuServer, TakesAtLeastTheTimeOfTheLine) {
  // 8 + 7 characters of 11 bits at 9600 are 17.2 ms.
  ModbusRtuServer server(bank_, {.timing = {.baud = 9600, .turnaround = milliseconds(4)}});
  SerialClient client(server.path());
  const auto start = HostClock::now();
  client.send(request());
  ASSERT_EQ(client.receive(7), answer());
  EXPECT_GE(HostClock::now() - start, microseconds(21180));
  client.send(request());
  ASSERT_EQ(client.receive(7), answer());
  EXPECT_GE(HostClock::now() - start, microseconds(2 * 21180 + 1750)) << "silence between the frames";
}

TEST_F(AnRtuServer, HandsBytesOverAtTheTicksOfTheAdapter) {
  ModbusRtuServer server(bank_, {.timing = {.usb_latency = milliseconds(16)}});
  SerialClient client(server.path());
  const auto start = HostClock::now();
  for (int i = 0; i < 5; ++i) {
    client.send(request());
    ASSERT_EQ(client.receive(7), answer());
  }
  EXPECT_GE(HostClock::now() - start, milliseconds(4 * 16)) << "one tick a transaction, the first at any time";
}

TEST_F(AnRtuServer, OutlivesItsClients) {
  ModbusRtuServer server(bank_, {});
  for (int i = 0; i < 5; ++i) {
    SerialClient client(server.path());
    ASSERT_TRUE(client.is_open());
    client.send(request());
    EXPECT_EQ(client.receive(7), answer());
  }
}

TEST_F(AnRtuServer, IsFoundByItsLink) {
  const fvd::test::ScratchDir scratch;
  const auto link = scratch.path() / "drive";
  std::filesystem::create_symlink("/nowhere", link);
  {
    ModbusRtuServer server(bank_, {.link = link});
    EXPECT_EQ(server.path(), link);
    SerialClient client(link);
    client.send(request());
    EXPECT_EQ(client.receive(7), answer());
  }
  EXPECT_FALSE(std::filesystem::is_symlink(link));
}

TEST_F(AnRtuServer, LeavesFilesThatAreNoLinksAlone) {
  const fvd::test::ScratchDir scratch;
  std::filesystem::create_directory(scratch.path() / "drive");
  fvd::test::expect_error(ErrorCode::kBadConfig, {"drive"},
                          [&] { ModbusRtuServer(bank_, {.link = scratch.path() / "drive"}); });
  EXPECT_TRUE(std::filesystem::is_directory(scratch.path() / "drive"));
}

TEST_F(AnRtuServer, RefusesALineThatCannotBe) {
  for (const ModbusRtuOptions& options :
       {ModbusRtuOptions{.unit = 0}, ModbusRtuOptions{.unit = 248}, ModbusRtuOptions{.timing = {.baud = 0}},
        ModbusRtuOptions{.timing = {.turnaround = milliseconds(-1)}}}) {
    fvd::test::expect_error(ErrorCode::kBadConfig, {"serial line"}, [&] { ModbusRtuServer(bank_, options); });
  }
}

TEST_F(AnRtuServer, TakesRequestsAndSaysNothingWhileMute) {
  ModbusRtuServer server(bank_, {});
  SerialClient client(server.path());
  server.set_mute(true);
  client.send(request());
  EXPECT_TRUE(client.receive(1, milliseconds(30)).empty());
  server.set_mute(false);
  client.send(request());
  EXPECT_EQ(client.receive(7), answer());
}

}  // namespace
}  // namespace fvd::sim
