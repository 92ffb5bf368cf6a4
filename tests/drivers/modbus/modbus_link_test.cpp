/// The link against lines that answer late, wrongly or not at all, on TCP and on a serial line.

#include "drivers/modbus/modbus_link.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <future>
#include <thread>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "tests/support/simulated_line.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::Transport;
using SteadyClock = std::chrono::steady_clock;

/// Register n reads 1000 + n until it is written. Remembers what was written, and when to the address of the stop.
class NumberedBank final : public sim::RegisterBank {
 public:
  static constexpr int kSize = 200;
  static constexpr int kStop = 150;

  NumberedBank() {
    for (int i = 0; i < kSize; ++i) values_[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(1000 + i);
  }
  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    if (address + static_cast<int>(values.size()) > kSize) return sim::ModbusException::kIllegalAddress;
    std::copy_n(values_.begin() + address, values.size(), values.begin());
    return sim::ModbusException::kNone;
  }
  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    if (address + static_cast<int>(values.size()) > kSize) return sim::ModbusException::kIllegalAddress;
    std::copy(values.begin(), values.end(), values_.begin() + address);
    if (address == kStop) stopped_ = SteadyClock::now();
    ++writes_;
    return sim::ModbusException::kNone;
  }
  [[nodiscard]] int writes() const { return writes_; }
  [[nodiscard]] SteadyClock::time_point stopped() const { return stopped_; }

 private:
  std::array<std::uint16_t, kSize> values_{};
  std::atomic<int> writes_{0};
  std::atomic<SteadyClock::time_point> stopped_{};
};

class AModbusLink : public testing::TestWithParam<Transport> {
 protected:
  [[nodiscard]] static ModbusReply read(ModbusLink& link, int address, int count = 1) {
    return link.read(ModbusTable::kHolding, address, count);
  }
  static ModbusReply write(ModbusLink& link, int address, std::uint16_t value,
                           ModbusPriority priority = ModbusPriority::kNormal) {
    return link.write(ModbusTable::kHolding, address, std::span(&value, 1), priority);
  }

  NumberedBank bank_;
  sim::FaultScript faults_;
  test::SimulatedLine line_{GetParam(), bank_, faults_};
};

TEST_P(AModbusLink, AnswersEveryOneOfTwelveAlternatingReadsAroundALateReply) {
  ModbusLink link(line_.config(milliseconds(100)));
  faults_.add({.on = sim::FaultOn::kRead, .after = 2, .fault = sim::FaultKind::kLateReply, .delay = milliseconds(160)});
  int right = 0;
  for (int i = 0; i < 12; ++i) {
    const int address = i % 2 == 0 ? 10 : 20;
    const ModbusReply reply = read(link, address, 2);
    ASSERT_EQ(reply.outcome, ModbusOutcome::kOk) << reply.error;
    if (reply.values[0] == 1000 + address && reply.values[1] == 1001 + address) ++right;
  }
  EXPECT_EQ(right, 12);
  EXPECT_EQ(faults_.unconsumed(), 0U) << faults_.describe_unconsumed();
  EXPECT_EQ(link.stats().unknown, 1U);
}

TEST_P(AModbusLink, DrainsWhatALateReplyLeavesOnASerialLine) {
  if (GetParam() == Transport::kTcp) GTEST_SKIP() << "a new socket holds no old bytes";
  ModbusLink link(line_.config(milliseconds(100)));
  faults_.add({.fault = sim::FaultKind::kLateReply, .delay = milliseconds(160)});
  EXPECT_EQ(read(link, 10, 2).values, (std::vector<std::uint16_t>{1010, 1011}));
  EXPECT_EQ(link.stats().discarded_bytes, 9U);
}

TEST_P(AModbusLink, NeverSendsAWriteTwice) {
  ModbusLink link(line_.config(milliseconds(100), milliseconds(120)));
  for (const auto fault : {sim::FaultKind::kLostReply, sim::FaultKind::kWrongCrc, sim::FaultKind::kTruncatedFrame}) {
    faults_.add({.on = sim::FaultOn::kWrite, .fault = fault});
    const int before = bank_.writes();
    EXPECT_EQ(write(link, 5, 7).outcome, ModbusOutcome::kUnknown);
    EXPECT_EQ(bank_.writes(), before + 1);
    EXPECT_EQ(read(link, 5).values, std::vector<std::uint16_t>{7}) << "the next request is answered right";
  }
  faults_.add({.on = sim::FaultOn::kWrite, .fault = sim::FaultKind::kLostRequest});
  const int before = bank_.writes();
  EXPECT_EQ(write(link, 6, 8).outcome, ModbusOutcome::kUnknown);
  EXPECT_EQ(bank_.writes(), before);
  EXPECT_EQ(faults_.unconsumed(), 0U) << faults_.describe_unconsumed();
}

TEST_P(AModbusLink, TakesALateAnswerToOneWriteForNoOther) {
  ModbusLink link(line_.config(milliseconds(100)));
  faults_.add({.on = sim::FaultOn::kWrite, .fault = sim::FaultKind::kLateReply, .delay = milliseconds(160)});
  faults_.add({.on = sim::FaultOn::kWrite, .fault = sim::FaultKind::kLostRequest});
  EXPECT_EQ(write(link, 5, 7).outcome, ModbusOutcome::kUnknown);
  EXPECT_EQ(write(link, 6, 8).outcome, ModbusOutcome::kUnknown) << "the answer to the first is not one to the second";
}

TEST_P(AModbusLink, RepeatsAReadTwiceAndNoMore) {
  ModbusLink link(line_.config(milliseconds(50), milliseconds(60)));
  faults_.add({.count = 2, .fault = sim::FaultKind::kLostReply});
  EXPECT_EQ(read(link, 3).values, std::vector<std::uint16_t>{1003});
  faults_.add({.count = 3, .fault = sim::FaultKind::kLostRequest});
  EXPECT_EQ(read(link, 3).outcome, ModbusOutcome::kUnknown);
  EXPECT_EQ(link.stats().retries, 4U);
  EXPECT_EQ(faults_.unconsumed(), 0U);
}

TEST_P(AModbusLink, TakesAnExceptionForARefusalAndGoesOn) {
  ModbusLink link(line_.config());
  faults_.add({.on = sim::FaultOn::kWrite, .fault = sim::FaultKind::kException, .code = 4});
  EXPECT_EQ(write(link, 5, 7).outcome, ModbusOutcome::kRejected);
  faults_.add({.on = sim::FaultOn::kWrite, .fault = sim::FaultKind::kException, .code = 0x12});
  EXPECT_EQ(write(link, 5, 7).outcome, ModbusOutcome::kRejected) << "a maker's own code";
  EXPECT_EQ(read(link, NumberedBank::kSize, 1).outcome, ModbusOutcome::kRejected);
  EXPECT_EQ(link.stats().unknown, 0U);
  EXPECT_EQ(link.stats().reconnects, 0U);
}

/// From the call of an urgent write to its execution by the drive.
double stop_latency_ms(ModbusLink& link, NumberedBank& bank) {
  const auto begin = SteadyClock::now();
  const std::uint16_t value = 1;
  for (int attempt = 0; attempt < 3 && bank.stopped() < begin; ++attempt) {
    (void)link.write(ModbusTable::kHolding, NumberedBank::kStop, std::span(&value, 1), ModbusPriority::kUrgent);
  }
  return std::chrono::duration<double, std::milli>(bank.stopped() - begin).count();
}

TEST_P(AModbusLink, LetsAStopThroughWithinOneResponseTimeoutUnderAnyFault) {
  constexpr milliseconds kTimeout{100};
  // Generous for a loaded machine; bench_stage measures the figure.
  constexpr double kMaxResponseTimeouts = 2.0;
  for (const auto fault : {sim::FaultKind::kLostReply, sim::FaultKind::kLostRequest, sim::FaultKind::kWrongCrc,
                           sim::FaultKind::kTruncatedFrame, sim::FaultKind::kException}) {
    SCOPED_TRACE(static_cast<int>(fault));
    ModbusLink link(line_.config(kTimeout));
    faults_.add({.on = sim::FaultOn::kRead, .fault = fault, .code = 4});
    std::promise<void> asked;
    std::jthread reader([&] {
      asked.set_value();
      (void)read(link, 1);
    });
    asked.get_future().wait();
    while (faults_.unconsumed() > 0) std::this_thread::yield();
    const double latency_ms = stop_latency_ms(link, bank_);
    EXPECT_GT(latency_ms, 0.0) << "the stop never arrived";
    EXPECT_LT(latency_ms, kMaxResponseTimeouts * static_cast<double>(kTimeout.count()));
  }
}

TEST_P(AModbusLink, ReadsAndWritesSingleRegisters) {
  ModbusLink link(line_.config());
  const std::uint16_t value = 77;
  EXPECT_EQ(
      link.write(ModbusTable::kHolding, 9, std::span(&value, 1), ModbusPriority::kNormal, {.single = true}).outcome,
      ModbusOutcome::kOk);
  EXPECT_EQ(link.read(ModbusTable::kInput, 9, 1).values, std::vector<std::uint16_t>{77});
  EXPECT_EQ(link.read(ModbusTable::kCoil, 9, 1).outcome, ModbusOutcome::kRejected) << "this bank has none";
}

INSTANTIATE_TEST_SUITE_P(On, AModbusLink, testing::Values(Transport::kTcp, Transport::kRtu),
                         [](const auto& on) { return testing::PrintToString(on.param); });

TEST(AModbusLinkConfig, RefusesWhatTheLineCannotBe) {
  const auto refusal = [](int baud, char parity, int stop_bits, int unit) {
    try {
      check({ModbusSerialEndpoint{"/dev/null", baud, parity, stop_bits}, unit, milliseconds(100), milliseconds(100)});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadConfig);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(115200, 'E', 1, 1), "");
  EXPECT_NE(refusal(123456, 'E', 1, 1).find("123456: expected one of 9600"), std::string::npos);
  EXPECT_NE(refusal(115200, 'X', 1, 1).find("parity X"), std::string::npos);
  EXPECT_NE(refusal(115200, 'E', 3, 1).find("3 stop bits"), std::string::npos);
  EXPECT_NE(refusal(115200, 'E', 1, 0).find("unit 0"), std::string::npos);
}

TEST(ASerialPort, IsTakenByOneProgramOnly) {
  NumberedBank bank;
  sim::FaultScript faults;
  const test::SimulatedLine line(Transport::kRtu, bank, faults);
  const ModbusLink first(line.config());
  try {
    const ModbusLink second(line.config());
    FAIL() << "opened twice";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kStageDisconnected);
    EXPECT_NE(std::string(error.what()).find("in use by another program"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fvd
