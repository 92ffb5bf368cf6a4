/// Which units a line has, and which only its gateway answers for.

#include "drivers/modbus/unit_scan.hpp"

#include <array>
#include <thread>

#include "gtest/gtest.h"
#include "tests/support/bent_line.hpp"

namespace fvd {
namespace {

constexpr std::uint8_t kBusyForNow = 3;
constexpr std::uint8_t kBusy = 4;
constexpr std::uint8_t kBehindNoPath = 5;

/// Header of Modbus TCP, then a register that is 17, or an exception.
test::LineBytes answer_to(const std::array<std::uint8_t, 12>& question, std::uint8_t exception) {
  test::LineBytes answer{question[0], question[1], 0, 0, 0, 3, question[6]};
  if (exception == 0) {
    answer[5] = 5;
    answer.insert(answer.end(), {question[7], 2, 0, 17});
  } else {
    answer.insert(answer.end(), {static_cast<std::uint8_t>(question[7] | 0x80U), exception});
  }
  return answer;
}

TEST(AScanOfUnits, ThroughAGatewayFindsNoneThatIsNotThere) {
  sockaddr_in address{};
  const sim::FileDescriptor listener(test::listen_on_loopback(8, address));
  const std::jthread gateway([&](const std::stop_token& stop) {
    bool was_busy = false;
    while (test::readable(listener.get(), stop)) {
      const sim::FileDescriptor client(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
      std::array<std::uint8_t, 12> question{};
      while (test::readable(client.get(), stop) &&
             ::recv(client.get(), question.data(), question.size(), MSG_WAITALL) == 12) {
        std::uint8_t exception = question[6] == kBehindNoPath ? 0x0A : 0x0B;
        if (question[6] == kBusy) exception = 6;
        if (question[6] == kBusyForNow) exception = std::exchange(was_busy, true) ? 0 : 5;
        const test::LineBytes answer = answer_to(question, exception);
        EXPECT_EQ(::send(client.get(), answer.data(), answer.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(answer.size()));
      }
    }
  });
  UnitScan scan;
  scan.line.endpoint = ModbusTcpEndpoint{"127.0.0.1", ntohs(address.sin_port)};
  scan.line.response_timeout = std::chrono::seconds(10);
  scan.last = 8;
  const auto found = scan_units(scan, {}, {});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].unit, kBusyForNow);
  EXPECT_EQ(found[0].answer, "register 0 is 17");
  EXPECT_EQ(found[1].unit, kBusy);
  EXPECT_EQ(found[1].answer, "exception 6: busy");
}

}  // namespace
}  // namespace fvd
