/// Who calls, and whose numbers are meant.

#include <set>

#include "daemon/api/rpc_errors.hpp"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

TEST_F(ADispatcher, KeepsTheNumbersOfClientsApart) {
  const json plc = result_of("job.start", {{"seq", 3}, {"part_id", "p"}});
  const json other = result_of("job.start", {{"seq", 3}, {"part_id", "q"}, {"client", "fvdctl"}});
  EXPECT_EQ(plc["client"], "plc") << "who gives no name is the plain PLC";
  EXPECT_EQ(other["client"], "fvdctl");
  EXPECT_EQ(other["duplicate"], false);
  EXPECT_EQ(service_.starts, 2);
  for (const char* method : {"job.status", "job.abort", "result.get"}) {
    EXPECT_EQ(result_of(method, {{"seq", 3}})["part_id"], "p") << method;
    EXPECT_EQ(result_of(method, {{"seq", 3}, {"client", "fvdctl"}})["part_id"], "q") << method;
    EXPECT_EQ(
        error_of(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", {{"seq", 3}, {"client", "nobody"}}}}
                     .dump()),
        1007)
        << method;
  }
  EXPECT_EQ(result_of("system.state")["client"], "") << "no job in the snapshot";
}

TEST_F(ADispatcher, TellsAClientItsHighestNumber) {
  EXPECT_EQ(result_of("job.latest", {{"client", "fvdctl"}})["seq"], 0);
  result_of("job.start", {{"seq", 41}, {"part_id", "p"}, {"client", "fvdctl"}});
  result_of("job.start", {{"seq", 4711}, {"part_id", "p"}});
  const json latest = result_of("job.latest", {{"client", "fvdctl"}});
  EXPECT_EQ(latest["seq"], 41);
  EXPECT_EQ(latest["job_id"], "job-fvdctl-41");
  EXPECT_EQ(result_of("job.latest")["seq"], 4711);
}

TEST_F(ADispatcher, RefusesClientsWithoutAProperName) {
  for (const std::string& name : {std::string(), std::string("a b"), std::string("a/b"), std::string("\xc3\xa4"),
                                  std::string(33, 'x'), std::string("a\0b", 3), std::string("\n")}) {
    for (const char* method : {"job.start", "job.status", "job.wait", "job.abort", "result.get", "result.ack"}) {
      json params{{"seq", 3}, {"client", name}};
      if (std::string(method) == "job.start") params["part_id"] = "p";
      EXPECT_EQ(error_of(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump()),
                json_rpc::kInvalidParams)
          << method << " " << name;
    }
  }
  EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"job.latest","params":{"client":""}})"),
            json_rpc::kInvalidParams);
  EXPECT_EQ(service_.starts, 0);
  EXPECT_EQ(result_of("job.start", {{"seq", 1}, {"part_id", "p"}, {"client", "Line-2_plc.1"}})["client"],
            "Line-2_plc.1");
}

TEST_F(ADispatcher, SaysOfEveryMethodThatMovesTheStageThatItDoes) {
  std::set<std::string> moving;
  for (const auto& [name, method] : dispatcher_.methods()) {
    if (method.about.moves_stage) moving.insert(name);
    EXPECT_TRUE(!method.about.moves_stage || method.about.needs_id) << name;
    EXPECT_TRUE(method.peek || method.run) << name;
  }
  EXPECT_EQ(moving, (std::set<std::string>{"job.start", "stage.autofocus", "stage.home", "stage.jog", "stage.move"}));
}

}  // namespace
}  // namespace fvd
