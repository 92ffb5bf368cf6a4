/// Replies that are too long for a connection: what becomes of them, and of those beside them.

#include "daemon/api/reply_size.hpp"

#include <limits>
#include <string>

#include "gmock/gmock.h"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

ordered_json reply_of(int id, std::size_t bytes) {
  return {{"jsonrpc", "2.0"}, {"id", id}, {"result", std::string(bytes, 'x')}};
}

TEST(AReplysSize, IsLeftAloneUpToTheLimit) {
  const ordered_json reply = reply_of(1, 100);
  const std::string line = reply.dump();
  EXPECT_EQ(line_within(reply, line.size()), line);
  EXPECT_EQ(line_within(reply, std::numeric_limits<std::size_t>::max()), line);
  EXPECT_EQ(line_within(ordered_json::array({reply, reply}), 1000), ordered_json::array({reply, reply}).dump());
}

TEST(AReplysSize, BecomesAnErrorThatSaysWhatToAskFor) {
  for (const json& id : {json(7), json("seven"), json(nullptr)}) {
    ordered_json reply = reply_of(0, 5000);
    reply["id"] = id;
    const std::string line = line_within(reply, 4999);
    EXPECT_LE(line.size(), 440U) << "as short as other errors of what a PLC polls";
    const json refused = json::parse(line);
    EXPECT_EQ(refused["id"], id);
    EXPECT_EQ(refused["error"]["code"], -32602);
    EXPECT_FALSE(refused.contains("result"));
    EXPECT_THAT(refused["error"]["message"].get<std::string>(),
                AllOf(HasSubstr(std::to_string(reply.dump().size())), HasSubstr("4999"), HasSubstr("most")));
  }
}

TEST(AReplysSize, HidesNothingShortThatStandsBesideIt) {
  const json told = json::parse(
      line_within(ordered_json::array({reply_of(1, 10), reply_of(2, 3000), reply_of(3, 900), reply_of(4, 10)}), 2000));
  ASSERT_EQ(told.size(), 4U);
  EXPECT_TRUE(told[0].contains("result"));
  EXPECT_TRUE(told[1].contains("error"));
  EXPECT_TRUE(told[2].contains("result"));
  EXPECT_TRUE(told[3].contains("result")) << "a start is told, whatever was asked for before it";
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(told[i]["id"], i + 1);
}

TEST_F(ADispatcher, KeepsToWhatACallersConnectionTakes) {
  service_.history.points.assign(100, {"J1", "part", "", {}});
  const std::string line =
      R"({"jsonrpc":"2.0","id":1,"method":"value.list","params":{"measurement":"step","value":"height_um"}})";
  EXPECT_TRUE(reply(line).contains("result")) << "by HTTP there is no limit";
  caller_.longest_reply_bytes = 2000;
  EXPECT_EQ(error_of(line), -32602);
  service_.history.points.clear();
  EXPECT_TRUE(reply(line).contains("result"));
}

TEST_F(ADispatcher, KnowsWhichLinesReadMuchForPeople) {
  const auto call = [](const std::string& method) { return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}}; };
  for (const char* method : {"job.list", "value.list", "result.profile", "audit.list"}) {
    EXPECT_TRUE(dispatcher_.is_long(call(method).dump())) << method;
    EXPECT_TRUE(dispatcher_.is_long(json::array({call("job.latest"), call(method)}).dump())) << method;
  }
  for (const char* method : {"job.start", "result.get", "job.latest", "nothing"}) {
    EXPECT_FALSE(dispatcher_.is_long(call(method).dump())) << method;
  }
  for (const char* line : {"", "[", "[]", "[1]", "7", "{}", R"({"method":7})", R"({"method":["job.list"]})"}) {
    EXPECT_FALSE(dispatcher_.is_long(line)) << line;
  }
}

}  // namespace
}  // namespace fvd
