/// Every fault of a line, seen from its other end: the same script on TCP and on a serial line.

#include <optional>

#include "gtest/gtest.h"
#include "sim/modbus/fault_script.hpp"
#include "sim/modbus/modbus_rtu_server.hpp"
#include "sim/modbus/modbus_tcp_server.hpp"
#include "tests/sim/modbus/modbus_requests.hpp"
#include "tests/sim/modbus/serial_client.hpp"
#include "tests/sim/modbus/tcp_client.hpp"

namespace fvd::sim {
namespace {

using std::chrono::milliseconds;
using test::SerialClient;
using test::short_request;
using test::TcpClient;

/// Longer than a loaded machine takes to answer; nothing is waited for so long unless nothing comes.
constexpr milliseconds kSilenceTimeout{100};

const ModbusBytes kWrite = short_request(6, 5, 0x1234);
const ModbusBytes kRead = short_request(3, 5, 1);
const ModbusBytes kValue{3, 2, 0x12, 0x34};

class FaultsOfATcpLine : public testing::Test {
 protected:
  void ask(TcpClient& client, const ModbusBytes& pdu) { client.send(TcpClient::frame(++transaction_, 1, pdu)); }
  [[nodiscard]] ModbusBytes reply(const ModbusBytes& pdu) const { return TcpClient::frame(transaction_, 1, pdu); }
  void expect_alive(TcpClient& client) {
    ask(client, kRead);
    EXPECT_EQ(client.receive(11), reply(kValue));
  }

  FaultScript script_;
  test::PlainBank bank_;
  ModbusTcpServer server_{bank_, {.faults = &script_}};
  int transaction_ = 100;
};

class FaultsOfASerialLine : public testing::Test {
 protected:
  static ModbusBytes frame(const ModbusBytes& pdu) { return SerialClient::frame(1, pdu); }
  void ask(const ModbusBytes& pdu) { client_.send(frame(pdu)); }
  void expect_alive() {
    ask(kRead);
    EXPECT_EQ(client_.receive(7), frame(kValue));
  }

  FaultScript script_;
  test::PlainBank bank_;
  ModbusRtuServer server_{bank_, {.faults = &script_}};
  SerialClient client_{server_.path()};
};

TEST_F(FaultsOfATcpLine, LateReply) {
  script_.add({.fault = FaultKind::kLateReply, .delay = milliseconds(150)});
  TcpClient client(server_.port());
  const auto start = HostClock::now();
  ask(client, kWrite);
  EXPECT_EQ(client.receive(12), reply(kWrite));
  EXPECT_GE(HostClock::now() - start, milliseconds(150));
  expect_alive(client);
}

TEST_F(FaultsOfASerialLine, LateReply) {
  script_.add({.fault = FaultKind::kLateReply, .delay = milliseconds(150)});
  const auto start = HostClock::now();
  ask(kWrite);
  EXPECT_EQ(client_.receive(8), frame(kWrite));
  EXPECT_GE(HostClock::now() - start, milliseconds(150));
  expect_alive();
}

TEST_F(FaultsOfATcpLine, LostReply) {
  script_.add({.on = FaultOn::kWrite, .fault = FaultKind::kLostReply});
  TcpClient client(server_.port());
  ask(client, kWrite);
  EXPECT_TRUE(client.receive(1, kSilenceTimeout).empty());
  EXPECT_TRUE(client.is_open());
  expect_alive(client);
}

TEST_F(FaultsOfASerialLine, LostReply) {
  script_.add({.on = FaultOn::kWrite, .fault = FaultKind::kLostReply});
  ask(kWrite);
  EXPECT_TRUE(client_.receive(1, kSilenceTimeout).empty());
  expect_alive();
}

TEST_F(FaultsOfATcpLine, LostRequest) {
  script_.add({.on = FaultOn::kWrite, .fault = FaultKind::kLostRequest});
  TcpClient client(server_.port());
  ask(client, kWrite);
  EXPECT_TRUE(client.receive(1, kSilenceTimeout).empty());
  ask(client, kRead);
  EXPECT_EQ(client.receive(11), reply({3, 2, 0, 0}));
}

TEST_F(FaultsOfASerialLine, LostRequest) {
  script_.add({.on = FaultOn::kWrite, .fault = FaultKind::kLostRequest});
  ask(kWrite);
  EXPECT_TRUE(client_.receive(1, kSilenceTimeout).empty());
  ask(kRead);
  EXPECT_EQ(client_.receive(7), frame({3, 2, 0, 0}));
}

TEST_F(FaultsOfATcpLine, WrongTransaction) {
  script_.add({.fault = FaultKind::kWrongCrc});
  TcpClient client(server_.port());
  ask(client, kWrite);
  const ModbusBytes wrong = client.receive(12);
  const ModbusBytes right = reply(kWrite);
  ASSERT_EQ(wrong.size(), right.size());
  EXPECT_NE(wrong[0], right[0]);
  EXPECT_TRUE(std::equal(wrong.begin() + 1, wrong.end(), right.begin() + 1));
  expect_alive(client);
}

TEST_F(FaultsOfASerialLine, WrongChecksum) {
  script_.add({.fault = FaultKind::kWrongCrc});
  ask(kWrite);
  const ModbusBytes wrong = client_.receive(8);
  const ModbusBytes right = frame(kWrite);
  ASSERT_EQ(wrong.size(), right.size());
  EXPECT_TRUE(std::equal(wrong.begin(), wrong.begin() + 6, right.begin()));
  EXPECT_NE(wrong, right);
  expect_alive();
}

TEST_F(FaultsOfATcpLine, TruncatedFrame) {
  script_.add({.fault = FaultKind::kTruncatedFrame});
  TcpClient client(server_.port());
  ask(client, kWrite);
  EXPECT_EQ(client.receive(12, kSilenceTimeout).size(), 6U);
  EXPECT_TRUE(client.is_open());
  expect_alive(client);
}

TEST_F(FaultsOfASerialLine, TruncatedFrame) {
  script_.add({.fault = FaultKind::kTruncatedFrame});
  ask(kWrite);
  EXPECT_EQ(client_.receive(8, kSilenceTimeout).size(), 4U);
  expect_alive();
}

TEST_F(FaultsOfATcpLine, Exception) {
  script_.add({.fault = FaultKind::kException, .code = 6});
  TcpClient client(server_.port());
  ask(client, kWrite);
  EXPECT_EQ(client.receive(9), reply({0x86, 6}));
  ask(client, kRead);
  EXPECT_EQ(client.receive(11), reply({3, 2, 0, 0}));
}

TEST_F(FaultsOfASerialLine, Exception) {
  script_.add({.fault = FaultKind::kException, .code = 6});
  ask(kWrite);
  EXPECT_EQ(client_.receive(5), frame({0x86, 6}));
}

TEST_F(FaultsOfATcpLine, LinkCut) {
  script_.add({.fault = FaultKind::kLinkCut, .delay = milliseconds(150)});
  TcpClient client(server_.port());
  TcpClient bystander(server_.port());
  bank_.set(5, 0x1234);
  const auto start = HostClock::now();
  ask(client, kWrite);
  EXPECT_TRUE(client.receive(1).empty());
  EXPECT_FALSE(client.is_open());
  TcpClient again(server_.port());
  expect_alive(again);
  EXPECT_GE(HostClock::now() - start, milliseconds(150));
  EXPECT_EQ(bank_.writes(), 0);
}

TEST_F(FaultsOfASerialLine, LinkCut) {
  script_.add({.fault = FaultKind::kLinkCut, .delay = milliseconds(300)});
  bank_.set(5, 0x1234);
  ask(kWrite);
  ask(kWrite);
  ModbusBytes reply;
  for (int attempt = 0; attempt < 50 && reply.empty(); ++attempt) {
    ask(kRead);
    reply = client_.receive(7, kSilenceTimeout);
  }
  EXPECT_EQ(reply, frame(kValue)) << "what was sent meanwhile is gone, and the line is back";
  EXPECT_EQ(bank_.writes(), 0);
}

TEST_F(FaultsOfATcpLine, OfTheServersOwnScript) {
  ModbusTcpServer own(bank_, {});
  own.lose_write_replies(1);
  own.delay_replies(1, milliseconds(30));
  TcpClient client(own.port());
  ask(client, kWrite);
  EXPECT_TRUE(client.receive(1, kSilenceTimeout).empty());
  expect_alive(client);
  own.lose_writes(1);
  ask(client, short_request(6, 5, 1));
  EXPECT_TRUE(client.receive(1, kSilenceTimeout).empty());
  expect_alive(client);
}

}  // namespace
}  // namespace fvd::sim
