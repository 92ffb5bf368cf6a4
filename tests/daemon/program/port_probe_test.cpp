#include "daemon/port_probe.hpp"

#include <gmock/gmock.h>

#include "tests/daemon/program/taken_port.hpp"

namespace fvd {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

TEST(PortProbe, SaysThatAnotherProgramHasThePortUntilItIsFree) {
  test::TakenPort taken;
  RpcConfig rpc{.port = taken.port()};
  EXPECT_THAT(why_no_port(rpc),
              Optional(HasSubstr("127.0.0.1:" + std::to_string(taken.port()) + ": another program has the port")));
  taken.free();
  EXPECT_EQ(why_no_port(rpc), std::nullopt);
  EXPECT_EQ(why_no_port(rpc), std::nullopt) << "asking keeps no port";
}

TEST(PortProbe, SaysThatNoCardHasTheAddress) {
  // TEST-NET-1 (RFC 5737): nobody's.
  EXPECT_THAT(why_no_port({.address = "192.0.2.1", .port = 0}),
              Optional(HasSubstr("no network card has this address")));
}

TEST(PortProbe, FindsAnyFreePortOfThisMachine) {
  EXPECT_EQ(why_no_port({.address = "127.0.0.1", .port = 0}), std::nullopt);
  EXPECT_EQ(why_no_port({.address = "0.0.0.0", .port = 0}), std::nullopt);
}

}  // namespace
}  // namespace fvd
