/// "Later" is not "gone", and an answer of somebody else is none: devices and gateways as they are.

#include <array>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "drivers/modbus/modbus_link.hpp"
#include "gtest/gtest.h"
#include "sim/base/pseudo_terminal.hpp"
#include "tests/support/bent_line.hpp"
#include "tests/support/busy_bank.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::expect_error;
using test::Transport;

constexpr int kAzTarget = 0x005C;
constexpr int kAzPosition = 0x00CC;

class ADriveThatPutsOff : public testing::TestWithParam<test::DriveCase> {
 protected:
  test::SimulatedDrive plant_{GetParam(), Transport::kTcp};
};

TEST_P(ADriveThatPutsOff, OneRequestInTenIsHomedAndMovedAllTheSame) {
  test::BusyBank busy(plant_.drive(), 0.1, 18);
  sim::FaultScript no_faults;
  const test::SimulatedLine line(Transport::kTcp, busy, no_faults);
  StageConfig config = plant_.config();
  config.port = std::get<ModbusTcpEndpoint>(line.config().endpoint).port;
  const auto stage = open_modbus_stage(config);
  stage->home({});
  const int before = plant_.drive().moves();
  for (int i = 1; i <= 6; ++i) {
    const MoveRecord move = stage->move_to(Micrometers{10.0 * i}, test::kCriterion, {});
    EXPECT_NEAR(move.position.value, 10.0 * i, 0.5);
    EXPECT_NEAR(plant_.axis().true_position_um(HostClock::now()), 10.0 * i, 0.75);
  }
  EXPECT_EQ(plant_.drive().moves(), before + 6) << "what was put off may have been executed: nothing moves twice";
  EXPECT_GT(busy.put_off(), 0);
  ASSERT_TRUE(stage->link_stats());
  EXPECT_GT(stage->link_stats()->put_off, 0U);
  EXPECT_EQ(stage->link_stats()->unanswered, 0U) << "it is no doubt of the line";
}

INSTANTIATE_TEST_SUITE_P(With, ADriveThatPutsOff, testing::ValuesIn(test::kDriveCases),
                         [](const auto& on) { return testing::PrintToString(on.param); });

class ALineToADrive : public testing::TestWithParam<Transport> {
 protected:
  static sim::FaultStep later(sim::FaultOn on, int code, int count = 1) {
    return {.on = on, .count = count, .fault = sim::FaultKind::kException, .code = code};
  }

  test::SimulatedDrive plant_{test::kDriveCases[0], GetParam()};
};

TEST_P(ALineToADrive, RepeatsAReadUntilTheDriveHasTimeForIt) {
  ModbusLink link(plant_.line().config());
  for (const int code : {5, 6, 0x0A, 0x0B}) {
    plant_.faults().add(later(sim::FaultOn::kRead, code, 4));
    EXPECT_EQ(link.read(ModbusTable::kHolding, kAzPosition, 2).outcome, ModbusOutcome::kOk) << code;
  }
  EXPECT_EQ(plant_.faults().unconsumed(), 0U);
  EXPECT_EQ(link.stats().later, 16U);
  EXPECT_EQ(link.stats().unknown, 0U);
  EXPECT_EQ(link.stats().reconnects, 0U);
}

TEST_P(ALineToADrive, RepeatsAWriteOnlyIfItDoesNoHarmTwice) {
  ModbusLink link(plant_.line().config());
  const std::array<std::uint16_t, 2> words{0, 7};
  plant_.faults().add(later(sim::FaultOn::kWrite, 6));
  const ModbusReply once = link.write(ModbusTable::kHolding, kAzTarget, words);
  EXPECT_EQ(once.outcome, ModbusOutcome::kUnknown);
  EXPECT_TRUE(once.later);
  EXPECT_EQ(once.error, "exception 6: busy");
  plant_.faults().add(later(sim::FaultOn::kWrite, 6, 3));
  EXPECT_EQ(link.write(ModbusTable::kHolding, kAzTarget, words, ModbusPriority::kNormal, {.repeatable = true}).outcome,
            ModbusOutcome::kOk);
}

TEST_P(ALineToADrive, HasNoPatienceWithoutEnd) {
  ModbusLinkConfig config = plant_.line().config();
  config.patience = milliseconds(100);
  ModbusLink link(config);
  plant_.faults().add(later(sim::FaultOn::kRead, 6, 1000));
  const ModbusReply reply = link.read(ModbusTable::kHolding, kAzPosition, 2);
  EXPECT_EQ(reply.outcome, ModbusOutcome::kUnknown);
  EXPECT_EQ(reply.error, "exception 6: busy, for 100 ms");
}

TEST_P(ALineToADrive, LetsAStopThroughWhileAReadIsPutOff) {
  ModbusLink link(plant_.line().config());
  plant_.faults().add(later(sim::FaultOn::kRead, 6, 100000));
  std::stop_source stop;
  auto reader = std::async(std::launch::async, [&] {
    return link.read(ModbusTable::kHolding, kAzPosition, 2, ModbusPriority::kNormal, stop.get_token());
  });
  while (link.stats().later < 3) std::this_thread::yield();
  const std::array<std::uint16_t, 2> words{0, 0x20};
  EXPECT_EQ(link.write(ModbusTable::kHolding, 0x0078, words, ModbusPriority::kUrgent).outcome, ModbusOutcome::kOk);
  stop.request_stop();
  EXPECT_TRUE(reader.get().later);
}

INSTANTIATE_TEST_SUITE_P(On, ALineToADrive, testing::Values(Transport::kTcp, Transport::kRtu),
                         [](const auto& on) { return testing::PrintToString(on.param); });

class ABentLine : public testing::Test {
 protected:
  [[nodiscard]] int drive_port() const { return std::get<ModbusTcpEndpoint>(plant_.line().config().endpoint).port; }
  [[nodiscard]] static ModbusLinkConfig to(const test::BentLine& line) {
    ModbusLinkConfig config;
    config.endpoint = ModbusTcpEndpoint{"127.0.0.1", line.port()};
    return config;
  }
  static ModbusReply read(ModbusLink& link) { return link.read(ModbusTable::kHolding, kAzPosition, 2); }
  [[nodiscard]] StageConfig stage_on(const test::BentLine& line) {
    StageConfig config = plant_.config();
    config.port = line.port();
    return config;
  }

  mutable test::SimulatedDrive plant_{test::kDriveCases[0], Transport::kTcp};
};

TEST_F(ABentLine, WithAnotherUnitsAnswersIsNotBelieved) {
  test::BentLine line(drive_port(), {.answer = [](test::LineBytes& answer) { answer[6] = 7; }});
  ModbusLink link(to(line));
  const ModbusReply reply = read(link);
  EXPECT_EQ(reply.outcome, ModbusOutcome::kUnknown);
  EXPECT_NE(reply.error.find("an answer of unit 7 to a question to unit 1"), std::string::npos) << reply.error;
  line.set_bent(false);
  EXPECT_EQ(read(link).outcome, ModbusOutcome::kOk);
}

TEST_F(ABentLine, OfAnotherProtocolIsNotBelieved) {
  test::BentLine line(drive_port(), {.answer = [](test::LineBytes& answer) { answer[3] = 1; }});
  ModbusLink link(to(line));
  const ModbusReply reply = read(link);
  EXPECT_EQ(reply.outcome, ModbusOutcome::kUnknown);
  EXPECT_NE(reply.error.find("another protocol"), std::string::npos) << reply.error;
}

TEST_F(ABentLine, WithAnswersToOtherQuestionsIsNotBelieved) {
  test::BentLine line(drive_port(), {.answer = [](test::LineBytes& answer) {
                        answer[0] = static_cast<std::uint8_t>(answer[0] ^ 0x40U);
                      }});
  ModbusLink link(to(line));
  EXPECT_EQ(read(link).outcome, ModbusOutcome::kUnknown);
}

TEST_F(ABentLine, ThatClosesAfterEveryAnswerIsServed) {
  const test::BentLine line(drive_port(), {.closes = true});
  const auto stage = open_modbus_stage(stage_on(line));
  stage->home({});
  const int before = plant_.drive().moves();
  for (int i = 1; i <= 3; ++i) {
    EXPECT_NEAR(stage->move_to(Micrometers{10.0 * i}, test::kCriterion, {}).position.value, 10.0 * i, 0.5);
  }
  EXPECT_EQ(plant_.drive().moves(), before + 3);
  EXPECT_GT(line.connections(), 10);
}

TEST_F(ABentLine, WithBytesBehindEveryAnswerIsServedAndCounted) {
  const test::BentLine line(drive_port(), {.trailing = {0xAB, 0xCD}});
  const auto stage = open_modbus_stage(stage_on(line));
  stage->home({});
  EXPECT_NEAR(stage->move_to(Micrometers{10.0}, test::kCriterion, {}).position.value, 10.0, 0.5);
  ASSERT_TRUE(stage->link_stats());
  EXPECT_GT(stage->link_stats()->discarded_bytes, 20U);
}

TEST(ALineWithLocalEcho, IsCalledThat) {
  const sim::PseudoTerminal terminal{{}};
  const std::jthread adapter([&](const std::stop_token& stop) {  // of two wires; there is no drive on them
    std::array<char, 256> bytes{};
    while (!stop.stop_requested()) {
      pollfd waiting{terminal.master(), POLLIN, 0};
      if (::poll(&waiting, 1, 20) <= 0) continue;
      const auto count = ::read(terminal.master(), bytes.data(), bytes.size());
      if (count <= 0) continue;
      EXPECT_EQ(::write(terminal.master(), bytes.data(), static_cast<std::size_t>(count)), count);
    }
  });
  ModbusLinkConfig config;
  config.endpoint = ModbusSerialEndpoint{terminal.path().string(), 115200, 'E', 1};
  config.quiet = milliseconds(20);
  ModbusLink link(config);
  for (const int address : {kAzPosition, 5000}) {  // taken for an answer, the second is longer than what comes
    const ModbusReply reply = link.read(ModbusTable::kHolding, address, 2);
    EXPECT_EQ(reply.outcome, ModbusOutcome::kUnknown);
    EXPECT_NE(reply.error.find("local echo"), std::string::npos) << reply.error;
  }
}

TEST(ASerialDeviceServer, ThatPassesBytesOnIsCalledThat) {
  // One that hands every connection's bytes to a serial line and back.
  test::SimulatedDrive plant(test::kDriveCases[0], Transport::kRtu);
  const auto serial = std::get<ModbusSerialEndpoint>(plant.line().config().endpoint);
  const sim::FileDescriptor port(::open(serial.device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  sockaddr_in address{};
  const sim::FileDescriptor listener(test::listen_on_loopback(8, address));
  const std::jthread server([&](const std::stop_token& stop) {
    while (test::readable(listener.get(), stop)) {
      const sim::FileDescriptor client(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
      std::array<char, 256> bytes{};
      for (bool open = true; open && !stop.stop_requested();) {
        std::array<pollfd, 2> waiting{{{client.get(), POLLIN, 0}, {port.get(), POLLIN, 0}}};
        (void)::poll(waiting.data(), waiting.size(), 20);
        if (waiting[0].revents != 0) {
          const auto count = ::recv(client.get(), bytes.data(), bytes.size(), 0);
          open = count > 0 && ::write(port.get(), bytes.data(), static_cast<std::size_t>(count)) == count;
        }
        if ((waiting[1].revents & POLLIN) != 0) {
          const auto count = ::read(port.get(), bytes.data(), bytes.size());
          if (count > 0) (void)::send(client.get(), bytes.data(), static_cast<std::size_t>(count), MSG_NOSIGNAL);
        }
      }
    }
  });
  ModbusLinkConfig config;
  config.endpoint = ModbusTcpEndpoint{"127.0.0.1", ntohs(address.sin_port)};
  ModbusLink link(config);
  EXPECT_EQ(link.read(ModbusTable::kHolding, kAzPosition, 2).error, "no answer in time");
  EXPECT_NE(link.advice().find("It answers serial frames (RTU over TCP)"), std::string::npos);
}

TEST(AHostThatDoesNotAnswer, IsNotCalledAnOperationInProgress) {
  // A listener whose queue is full takes no further connection and refuses none.
  sockaddr_in address{};
  const sim::FileDescriptor listener(test::listen_on_loopback(0, address));
  std::vector<std::unique_ptr<sim::FileDescriptor>> waiting;
  for (int i = 0; i < 4; ++i) {
    waiting.push_back(
        std::make_unique<sim::FileDescriptor>(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)));
    (void)::connect(waiting.back()->get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  }
  ModbusLinkConfig config;
  config.endpoint = ModbusTcpEndpoint{"127.0.0.1", ntohs(address.sin_port)};
  expect_error(ErrorCode::kStageDisconnected, {"nobody answered the connection within 180 ms"},
               [&] { const ModbusLink link(config); });
}

}  // namespace
}  // namespace fvd
