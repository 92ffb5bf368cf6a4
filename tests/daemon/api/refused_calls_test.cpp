/// Refusals of callers without a role: told, but not each of them.

#include "daemon/api/refused_calls.hpp"

#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/support/captured_log.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(RefusedCalls, AreToldOnceASecondWithTheirNumber) {
  RefusedCalls refused;
  const HostTime begin{seconds(1000)};
  EXPECT_EQ(refused.count_to_tell("a", begin), 1U);
  for (int i = 1; i < 1000; ++i) EXPECT_FALSE(refused.count_to_tell("a", begin + milliseconds(i)));
  EXPECT_EQ(refused.count_to_tell("b", begin + milliseconds(999)), 1000U) << "another caller, and what was not told";
  EXPECT_EQ(refused.count_to_tell("a", begin + seconds(1)), 1U);
}

TEST(RefusedCalls, AreKnownOfTheLatestCallers) {
  RefusedCalls refused;
  HostTime now{seconds(1000)};
  const auto last = std::to_string(RefusedCalls::kMostCallers);
  for (std::size_t i = 0; i <= RefusedCalls::kMostCallers; ++i) {
    EXPECT_TRUE(refused.count_to_tell(std::to_string(i), now += seconds(1)));
  }
  EXPECT_FALSE(refused.count_to_tell(last, now));
  EXPECT_EQ(refused.count_to_tell("0", now), 2U) << "it gave way";
}

TEST(RefusedCalls, AreToldAFewTimesASecondFromHoweverManyAddresses) {
  RefusedCalls refused;
  const HostTime begin{seconds(1000)};
  std::size_t told = 0;
  std::uint64_t counted = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto count = refused.count_to_tell(std::to_string(i), begin + milliseconds(i));
    told += count ? 1 : 0;
    counted += count.value_or(0);
  }
  EXPECT_EQ(told, 5 * RefusedCalls::kMostAPause);
  counted += refused.count_to_tell("0", begin + seconds(10)).value_or(0);
  EXPECT_EQ(counted, 5001U) << "none is lost";
}

/// At most one line a second of one caller.
void expect_few(const test::CapturedLog& log, const std::string& words, HostTime begin) {
  const auto lines = log.lines_with(words);
  EXPECT_GE(lines, 1U);
  EXPECT_LE(lines, 1 + static_cast<std::size_t>((HostClock::now() - begin) / seconds(1))) << words;
}

TEST_F(ADispatcher, WarnsOnceASecondOfAStrangersLogInThatHasNoId) {
  caller_.who = {"address 10.0.0.9", Role::kNone};
  const test::CapturedLog log;
  const HostTime begin = HostClock::now();
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(dispatcher_.handle(R"({"jsonrpc":"2.0","method":"session.login"})", caller_).reply);
  }
  expect_few(log, "session.login without an id", begin);
}

TEST(RefusedCalls, AreFewLinesWhereTheTokensCannotBeRead) {
  FakeJobService service;
  service.access_config.token_file = "/no/such/folder/tokens";
  const Dispatcher dispatcher{all_methods(service.services()), service.services()};
  const Caller stranger{.who = {"address 10.0.0.9", Role::kNone}};
  const test::CapturedLog log;
  const HostTime begin = HostClock::now();
  for (int i = 0; i < 200; ++i) {
    const auto handled =
        dispatcher.handle(R"({"jsonrpc":"2.0","id":1,"method":"session.login","params":{"token":"t"}})", stranger);
    ASSERT_TRUE(handled.reply);
    EXPECT_NE(handled.reply->find("1015"), std::string::npos) << *handled.reply;
  }
  expect_few(log, "session.login was refused", begin);
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
