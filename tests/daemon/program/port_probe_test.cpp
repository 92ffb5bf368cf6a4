#include "daemon/port_probe.hpp"

#include <gmock/gmock.h>

#include "tests/daemon/program/taken_port.hpp"

namespace fvd {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

TEST(PortProbe, SaysThatAnotherProgramHasThePortUntilItIsFree) {
  test::TakenPort taken;
  EXPECT_THAT(why_no_port("127.0.0.1", taken.port()),
              Optional(HasSubstr("127.0.0.1:" + std::to_string(taken.port()) + ": another program has the port")));
  taken.free();
  EXPECT_EQ(why_no_port("127.0.0.1", taken.port()), std::nullopt);
  EXPECT_EQ(why_no_port("127.0.0.1", taken.port()), std::nullopt) << "asking keeps no port";
}

TEST(PortProbe, SaysThatNoCardHasTheAddress) {
  // TEST-NET-1 (RFC 5737): nobody's.
  EXPECT_THAT(why_no_port("192.0.2.1", 0), Optional(HasSubstr("no network card has this address")));
}

TEST(PortProbe, FindsAnyFreePortOfThisMachine) {
  EXPECT_EQ(why_no_port("127.0.0.1", 0), std::nullopt);
  EXPECT_EQ(why_no_port("0.0.0.0", 0), std::nullopt);
}

}  // namespace
}  // namespace fvd
