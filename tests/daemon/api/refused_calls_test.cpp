/// Refused calls: told, but not each of them.

#include "daemon/access/refused_calls.hpp"

#include <sstream>
#include <string>

#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/support/captured_log.hpp"

namespace fvd {
namespace {

using std::chrono::seconds;

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

TEST_F(ADispatcher, WarnsOnceASecondOfACallerWithARoleToo) {
  caller_.who = {"token guest", Role::kView};
  const test::CapturedLog log;
  const HostTime begin = HostClock::now();
  for (int i = 0; i < 200; ++i) EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"stage.stop"})"), 1004);
  expect_few(log, "stage.stop was refused", begin);
}

TEST(RefusedCalls, AreLimitedOverAllWaysInTogether) {
  FakeJobService service;
  const Dispatcher lines{all_methods(service.services()), service.services()};
  const Dispatcher http{all_methods(service.services()), service.services()};
  const test::CapturedLog log;
  const HostTime begin = HostClock::now();
  for (int i = 0; i < 100; ++i) {
    const Caller stranger{.who = {"address 10.0.0." + std::to_string(i), Role::kNone}};
    (void)(i % 2 == 0 ? lines : http).handle(R"({"jsonrpc":"2.0","id":1,"method":"stage.stop"})", stranger);
  }
  const auto pauses = 1 + static_cast<std::size_t>((HostClock::now() - begin) / RefusedCalls::kPause);
  EXPECT_LE(log.lines_with("stage.stop was refused"), RefusedCalls::kMostAPause * pauses);
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
  EXPECT_GE(log.lines_with("details: cannot read /no/such/folder/tokens"), 1U) << "the log says why";
  std::istringstream lines(log.text());
  for (std::string line; std::getline(lines, line);) {
    if (line.find("/no/such") == std::string::npos) continue;
    EXPECT_NE(line.find("[info]"), std::string::npos) << "no alarm, which every viewer reads, says it: " << line;
  }
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
