/// What a line relies on: errors of their own, and a description of the order.

#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

TEST_F(ADispatcher, TellsAResultThatWasRemovedByAnErrorOfItsOwn) {
  result_of("job.start", {{"seq", 3}, {"part_id", "p"}});
  service_.change({3}, [](JobStatus& job) {
    job.state = JobState::kCompleted;
    job.removed_utc = "2026-11-30T10:00:00.000Z";
  });
  for (const char* format : {"compact", "full", "complete"}) {
    const json answer = reply(
        json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "result.get"}, {"params", {{"seq", 3}, {"format", format}}}}
            .dump());
    EXPECT_EQ(answer["error"]["code"], 1018) << answer;
    EXPECT_EQ(answer["error"]["data"]["error"], "result_removed");
  }
}

TEST_F(ADispatcher, DescribesUnitsRangesErrorsAndTheOrderOfALine) {
  const json document = result_of("rpc.discover");
  EXPECT_GE(document["x-line"]["order"].size(), 5U);
  EXPECT_EQ(document["x-line"]["times"]["reply_ms"]["value"], 1000);
  EXPECT_GT(document["x-errors"].size(), static_cast<std::size_t>(kLastErrorCode));
  const auto method = [&](const std::string& name) {
    for (const json& one : document["methods"]) {
      if (one["name"] == name) return one;
    }
    return json();
  };
  const json status = method("job.status")["result"]["schema"]["properties"];
  EXPECT_EQ(status["age_s"]["x-unit"], "s");
  EXPECT_EQ(status["progress"]["maximum"], 1);
  EXPECT_EQ(status["part_id"]["maxLength"], 64);
  EXPECT_EQ(status["state"]["enum"], json({"processing", "completed", "aborted", "failed"}));
  const json result = method("result.get");
  EXPECT_EQ(result["result"]["schema"]["properties"]["height_min_um"]["x-unit"], "um");
  EXPECT_EQ(result["errors"][1]["code"], 1018);
  EXPECT_FALSE(result["errors"][1]["x-meaning"].get<std::string>().empty());
  for (const json& one : document["methods"]) {
    for (const auto& [key, property] : one["result"]["schema"]["properties"].items()) {
      EXPECT_FALSE(property.value("description", "").empty()) << one["name"] << key;
    }
  }
}

}  // namespace
}  // namespace fvd
