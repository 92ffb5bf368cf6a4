/// Refusals of callers without a role: told, but not each of them.

#include "daemon/api/refused_calls.hpp"

#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(RefusedCalls, AreToldOnceASecondWithTheirNumber) {
  RefusedCalls refused;
  const HostTime begin{seconds(1000)};
  EXPECT_EQ(refused.count_to_tell("a", begin), 1U);
  for (int i = 1; i < 1000; ++i) EXPECT_FALSE(refused.count_to_tell("a", begin + milliseconds(i)));
  EXPECT_EQ(refused.count_to_tell("b", begin + milliseconds(999)), 1U) << "another caller";
  EXPECT_EQ(refused.count_to_tell("a", begin + seconds(1)), 1000U);
  EXPECT_EQ(refused.count_to_tell("a", begin + seconds(2)), 1U);
}

TEST(RefusedCalls, AreKnownOfTheLatestCallers) {
  RefusedCalls refused;
  HostTime now{seconds(1000)};
  for (std::size_t i = 0; i <= RefusedCalls::kMostCallers; ++i) {
    EXPECT_TRUE(refused.count_to_tell(std::to_string(i), now += std::chrono::microseconds(1)));
  }
  EXPECT_FALSE(refused.count_to_tell("1", now));
  EXPECT_TRUE(refused.count_to_tell("0", now)) << "it gave way";
}

TEST_F(ADispatcher, WritesNoRowOfStrangersItRefuses) {
  const std::string start = R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":{"seq":1,"part_id":"p"}})";
  const std::string log_in = R"({"jsonrpc":"2.0","id":1,"method":"session.login","params":{"token":"wrong"}})";
  caller_.who = {"address 10.0.0.9", Role::kNone};
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(error_of(start), 1004);
    EXPECT_EQ(error_of(log_in), 1004);
  }
  EXPECT_TRUE(service_.audit.newest(10, 0).empty());
  caller_.who = {"token guest", Role::kView};
  EXPECT_EQ(error_of(start), 1004);
  const auto entries = service_.audit.newest(10, 0);
  ASSERT_EQ(entries.size(), 1U) << "of who is known each";
  EXPECT_EQ(entries.front().outcome, "not_allowed");
}

}  // namespace
}  // namespace fvd
