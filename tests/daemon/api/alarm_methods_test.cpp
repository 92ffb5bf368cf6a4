/// Alarms by JSON-RPC: who may acknowledge them, which one, and what is written down of it.

#include "gmock/gmock.h"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

std::string acknowledge(const json& params) {
  return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "alarm.acknowledge"}, {"params", params}}.dump();
}

using AnAlarmList = ADispatcher;

TEST_F(AnAlarmList, TellsTheNewestFirst) {
  service_.alarms.note(AlarmLevel::kCritical, "no job is taken", std::chrono::system_clock::time_point{});
  service_.alarms.note(AlarmLevel::kError, "job J failed: \xff\"<b>\"", std::chrono::system_clock::time_point{});

  const json alarms = result_of("alarm.list")["alarms"];

  ASSERT_EQ(alarms.size(), 3U);
  EXPECT_EQ(alarms[1], json::parse(R"({"number": 2, "time_utc": "1970-01-01T00:00:00.000Z",
      "last_utc": "1970-01-01T00:00:00.000Z", "level": "critical", "text": "no job is taken", "count": 1,
      "acknowledged": false})"));
  EXPECT_EQ(alarms[0]["text"], "job J failed: ?\"<b>\"");
  EXPECT_EQ(alarms[0]["level"], "error");
  EXPECT_EQ(alarms[2]["level"], "warning");
}

TEST_F(AnAlarmList, HasTheOneAcknowledgedThatWasNamed) {
  service_.alarms.note(AlarmLevel::kError, "second", {});
  service_.alarms.note(AlarmLevel::kError, "third", {});

  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(result_of("alarm.acknowledge", {{"number", 2}}), (json{{"acknowledged", 2}})) << "repeated too";
    const json alarms = result_of("alarm.list")["alarms"];
    EXPECT_EQ(alarms[0]["acknowledged"], false);
    EXPECT_EQ(alarms[1]["acknowledged"], true);
    EXPECT_EQ(alarms[2]["acknowledged"], false) << "not those before it";
  }
}

TEST_F(AnAlarmList, RefusesANumberThatItHasNot) {
  const json answer = reply(acknowledge({{"number", 7}}));
  EXPECT_EQ(answer["error"]["data"]["error"], error_name(ErrorCode::kBadInput));
  EXPECT_THAT(answer["error"]["message"].get<std::string>(), AllOf(HasSubstr("no alarm 7"), HasSubstr("alarm.list")));
  for (const json& wrong : {json::object(), json{{"number", 0}}, json{{"number", -1}}, json{{"number", 1.5}},
                            json{{"number", "1"}}, json{{"number", nullptr}}, json{{"number", 1e300}},
                            json{{"number", json::array({1})}}, json{{"number", 1}, {"all", true}}}) {
    EXPECT_EQ(error_of(acknowledge(wrong)), -32602) << wrong;
  }
  EXPECT_FALSE(service_.alarms.newest().front().acknowledged);
}

TEST_F(AnAlarmList, HasNoneAcknowledgedThatIsOfAnotherTime) {
  const std::string time = "1970-01-01T00:00:00.000Z";
  const json answer = reply(acknowledge({{"number", 1}, {"time_utc", "2026-11-30T10:00:00.000Z"}}));
  EXPECT_EQ(answer["error"]["data"]["error"], error_name(ErrorCode::kBadInput));
  EXPECT_THAT(answer["error"]["message"].get<std::string>(), AllOf(HasSubstr(time), HasSubstr("alarm.list")));
  for (const json& wrong : {json(5), json(nullptr), json(std::string(65, '1'))}) {
    EXPECT_EQ(error_of(acknowledge({{"number", 1}, {"time_utc", wrong}})), -32602) << wrong;
  }
  EXPECT_FALSE(service_.alarms.newest().front().acknowledged);
  result_of("alarm.acknowledge", {{"number", 1}, {"time_utc", time}});
  EXPECT_TRUE(service_.alarms.newest().front().acknowledged);
}

TEST_F(AnAlarmList, IsForWhoOperatesToAcknowledgeAndForAllToRead) {
  const Caller viewer{.who = {"viewer", Role::kView}};
  const auto code_of = [&](const Caller& caller, const std::string& line) {
    return json::parse(dispatcher_.handle(line, caller).reply.value()).value("/error/code"_json_pointer, 0);
  };
  EXPECT_EQ(code_of(viewer, R"({"jsonrpc":"2.0","id":1,"method":"alarm.list"})"), 0);
  EXPECT_EQ(code_of(viewer, acknowledge({{"number", 1}})), 1004);
  EXPECT_FALSE(service_.alarms.newest().front().acknowledged);
  EXPECT_EQ(code_of({.who = {"kiosk", Role::kOperate}}, acknowledge({{"number", 1}})), 0);
  EXPECT_TRUE(service_.alarms.newest().front().acknowledged);
}

TEST_F(AnAlarmList, NeedsNoControl) {
  (void)service_.control.acquire({{"address 10.0.0.7", Role::kOperate}, "line-2", std::chrono::seconds(60), false});
  result_of("alarm.acknowledge", {{"number", 1}});
}

TEST_F(AnAlarmList, IsWrittenDownByWhom) {
  result_of("alarm.acknowledge", {{"number", 1}});
  (void)reply(acknowledge({{"number", 9}}));

  const auto entries = service_.audit.newest(10, 0);
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[1].what, "alarm.acknowledge");
  EXPECT_EQ(entries[1].who, "test");
  EXPECT_EQ(entries[1].outcome, "ok");
  EXPECT_THAT(entries[1].detail, HasSubstr("\"number\":1"));
  EXPECT_EQ(entries[0].outcome, error_name(ErrorCode::kBadInput));
}

}  // namespace
}  // namespace fvd
