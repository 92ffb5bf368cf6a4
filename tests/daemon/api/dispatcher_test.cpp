/// JSON-RPC 2.0 to the letter, and the refusals a PLC programmer will meet.

#include <set>

#include "core/base/error.hpp"
#include "daemon/api/rpc_errors.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/result/evaluate.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/daemon/export/sample_result.hpp"

namespace fvd {
namespace {

using nlohmann::json;

TEST_F(ADispatcher, RefusesWhatIsNoJson) {
  for (const char* line :
       {"{", "nonsense", "{\"a\":1}x", "\xff\xfe", "[1,", "{\"jsonrpc\":\"2.0\",\"id\":1,\"id\":2}", "{/**/}"}) {
    EXPECT_EQ(error_of(line), json_rpc::kParseError) << line;
    EXPECT_TRUE(reply(line)["id"].is_null());
  }
}

TEST_F(ADispatcher, RefusesDeepNestingBeforeAnythingRecurses) {
  EXPECT_EQ(error_of(std::string(33, '[') + std::string(33, ']')), json_rpc::kParseError);
  EXPECT_EQ(error_of(std::string(60000, '[')), json_rpc::kParseError);
  std::string object = R"({"jsonrpc":"2.0","id":1,"method":"system.ping","params":{"t":)";
  EXPECT_EQ(error_of(object + std::string(40, '[') + std::string(40, ']') + "}}"), json_rpc::kParseError);
}

TEST_F(ADispatcher, RefusesWhatIsNoRequest) {
  for (const char* line :
       {"1", "null", "\"text\"", "{}", R"({"jsonrpc":"2.0","id":1.5,"method":"system.ping"})",
        R"({"jsonrpc":"2.0","id":true,"method":"system.ping"})", R"({"jsonrpc":"2.0","id":[],"method":"system.ping"})",
        R"({"jsonrpc":"2.0","id":12345678901234567890123,"method":"system.ping"})",
        R"({"jsonrpc":"2.0","id":9007199254740992,"method":"system.ping"})",
        R"({"jsonrpc":"2.0","id":9007199254740993.0,"method":"system.ping"})"}) {
    EXPECT_EQ(error_of(line), json_rpc::kInvalidRequest) << line;
    EXPECT_TRUE(reply(line)["id"].is_null()) << line;
  }
}

TEST_F(ADispatcher, AnswersByTheIdThatStandsBesideAnotherFault) {
  for (const char* line :
       {R"({"jsonrpc":2.0,"id":7,"method":"system.ping"})", R"({"jsonrpc":"1.0","id":7,"method":"system.ping"})",
        R"({"id":7,"method":"system.ping"})", R"({"jsonrpc":"2.0","id":7})", R"({"jsonrpc":"2.0","id":7,"method":5})",
        R"({"jsonrpc":"2.0","id":7,"method":"system.ping","params":"bar"})"}) {
    EXPECT_EQ(error_of(line), json_rpc::kInvalidRequest) << line;
    EXPECT_EQ(reply(line)["id"], 7) << line;
  }
}

TEST_F(ADispatcher, EchoesTheIdAsItCame) {
  for (const json& id :
       {json(1), json("1"), json(nullptr), json(-5), json("abc"), json(9007199254740991), json(1.0), json(-3.0)}) {
    EXPECT_EQ(reply(json{{"jsonrpc", "2.0"}, {"id", id}, {"method", "system.ping"}}.dump())["id"], id);
  }
}

TEST_F(ADispatcher, NeverAnswersANotification) {
  for (const char* line : {R"({"jsonrpc":"2.0","method":"system.ping"})", R"({"jsonrpc":"2.0","method":"no.such"})",
                           R"({"jsonrpc":"2.0","method":"job.start","params":{"wrong":1}})",
                           R"([{"jsonrpc":"2.0","method":"system.ping"}])"}) {
    EXPECT_FALSE(dispatcher_.handle(line, caller_).reply.has_value()) << line;
  }
}

TEST_F(ADispatcher, NeverStartsOrMovesAnythingForANotification) {
  for (const char* line :
       {R"({"jsonrpc":"2.0","method":"job.start","params":[1,"p"]})",
        R"([{"jsonrpc":"2.0","method":"job.start","params":[1,"p"]}])",
        R"({"jsonrpc":"2.0","method":"stage.move","params":[10.0]})", R"({"jsonrpc":"2.0","method":"stage.home"})"}) {
    EXPECT_FALSE(dispatcher_.handle(line, caller_).reply.has_value()) << line;
    EXPECT_FALSE(dispatcher_.handle(line, caller_).waiting.has_value()) << line;
  }
  EXPECT_EQ(service_.starts, 0);
  EXPECT_EQ(service_.task, nullptr);
}

TEST_F(ADispatcher, TellsTheEngineWhichCommandsMoveTheStage) {
  for (const char* method : {"camera.snap", "camera.preview", "camera.suggest_exposure", "stage.home"}) {
    (void)dispatcher_.handle(R"({"jsonrpc":"2.0","id":1,"method":")" + std::string(method) + "\"}", caller_);
  }
  (void)dispatcher_.handle(R"({"jsonrpc":"2.0","id":1,"method":"stage.move","params":[10.0]})", caller_);
  (void)dispatcher_.handle(R"({"jsonrpc":"2.0","id":1,"method":"stage.autofocus","params":{"from_um":0,"to_um":50}})",
                           caller_);
  using enum TaskMotion;
  EXPECT_EQ(service_.motions, (std::vector<TaskMotion>{kNone, kNone, kNone, kMoves, kMoves, kMoves}));
}

TEST_F(ADispatcher, AnswersFromTheSnapshotWhatItCan) {
  JobStatus running;
  running.job_id = "job-8";
  running.request.seq = 8;
  service_.current = running;
  for (const char* line :
       {R"({"jsonrpc":"2.0","id":1,"method":"system.ping"})", R"({"jsonrpc":"2.0","id":1,"method":"system.state"})",
        R"({"jsonrpc":"2.0","id":1,"method":"system.info"})",
        R"([{"jsonrpc":"2.0","id":1,"method":"system.ping"},{"jsonrpc":"2.0","id":2,"method":"system.state"}])",
        R"({"jsonrpc":"2.0","id":1,"method":"no.such"})", R"({"jsonrpc":"2.0","id":1,"method":"job.start"})", "{"}) {
    const auto handled = dispatcher_.try_handle(line, caller_);
    ASSERT_TRUE(handled.has_value()) << line;
    EXPECT_EQ(handled->reply, dispatcher_.handle(line, caller_).reply) << line;
  }
  for (const JobState state : {JobState::kProcessing, JobState::kCompleted}) {
    service_.current->state = state;
    const auto status =
        dispatcher_.try_handle(R"({"jsonrpc":"2.0","id":1,"method":"job.status","params":{"seq":8}})", caller_);
    ASSERT_TRUE(status.has_value()) << "the job that runs, and when it has ended: another's start may be on its way";
    EXPECT_EQ(json::parse(status->reply.value())["result"]["job_id"], "job-8");
  }
}

TEST_F(ADispatcher, LeavesToHandleWhatMayBlock) {
  const json params_of{{"recipe.get", {{"id", "chapter"}}},
                       {"recipe.prepare", {{"id", "chapter"}}},
                       {"recipe.list", json::object()},
                       {"recipe.check", {{"text", "{}"}}},
                       {"recipe.versions", {{"id", "chapter"}}},
                       {"recipe.save", {{"id", "chapter"}, {"text", ""}, {"base_version", 3}, {"author", "a"}}},
                       {"recipe.restore", {{"id", "chapter"}, {"version", 1}, {"base_version", 3}, {"author", "a"}}},
                       {"job.start", {{"seq", 1}, {"part_id", "p"}}},
                       {"job.status", {{"seq", 1}}},
                       {"rpc.discover", json::object()},
                       {"job.wait", {{"seq", 1}}},
                       {"job.abort", {{"seq", 1}}},
                       {"result.get", {{"seq", 1}}},
                       {"result.next", json::object()},
                       {"result.ack", {{"seq", 1}}},
                       {"stage.accuracy", json::object()},
                       {"stage.home", json::object()},
                       {"stage.move", {{"z_um", 1}}},
                       {"camera.snap", json::object()},
                       {"camera.preview", json::object()}};
  for (const auto& [method, params] : params_of.items()) {
    const json request{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}};
    EXPECT_FALSE(dispatcher_.try_handle(request.dump(), caller_).has_value()) << method;
    if (method == "job.abort") continue;  // urgent ones are refused in a batch, at once
    const json ping{{"jsonrpc", "2.0"}, {"id", 2}, {"method", "system.ping"}};
    EXPECT_FALSE(dispatcher_.try_handle(json{ping, request}.dump(), caller_).has_value()) << method << " in a batch";
  }
  EXPECT_EQ(service_.starts, 0);
  EXPECT_EQ(service_.task, nullptr);
}

TEST_F(ADispatcher, AnswersBatchesInOrder) {
  const json answer =
      reply(R"([{"jsonrpc":"2.0","id":1,"method":"system.ping"},{"jsonrpc":"2.0","method":"system.ping"},5,
                                {"jsonrpc":"2.0","id":2,"method":"no.such"}])");
  ASSERT_TRUE(answer.is_array());
  ASSERT_EQ(answer.size(), 3U);
  EXPECT_EQ(answer[0]["id"], 1);
  EXPECT_EQ(answer[1]["error"]["code"], json_rpc::kInvalidRequest);
  EXPECT_EQ(answer[2]["error"]["code"], json_rpc::kMethodNotFound);
  EXPECT_EQ(error_of("[]"), json_rpc::kInvalidRequest);
}

TEST_F(ADispatcher, LimitsBatches) {
  json pings = json::array();
  for (int id = 0; id < 17; ++id) pings.push_back({{"jsonrpc", "2.0"}, {"id", id}, {"method", "system.ping"}});
  const json answer = reply(pings.dump());
  ASSERT_EQ(answer.size(), 17U) << "member by member";
  for (int id = 0; id < 17; ++id) {
    EXPECT_EQ(answer[static_cast<std::size_t>(id)]["id"], id);
    EXPECT_EQ(answer[static_cast<std::size_t>(id)]["error"]["code"], json_rpc::kInvalidRequest);
  }
  EXPECT_EQ(reply(json(std::vector<json>(1000, json(5))).dump()).size(), 1U) << "the nameless get one answer";
  EXPECT_EQ(reply(json(std::vector<json>(1024, json{{"id", 1}})).dump()).size(), 1024U);
  EXPECT_EQ(reply(json(std::vector<json>(1025, json{{"id", 1}})).dump()).size(), 1U) << "what is said stays short";
  const json start{{"jsonrpc", "2.0"}, {"id", 1}, {"method", "job.start"}, {"params", {{"seq", 1}, {"part_id", "p"}}}};
  for (const json& refused : reply(json{start, start}.dump())) {
    EXPECT_EQ(refused["error"]["code"], json_rpc::kInvalidRequest);
    EXPECT_EQ(refused["id"], 1);
  }
  EXPECT_EQ(service_.starts, 0);
}

TEST_F(ADispatcher, RefusesUnknownMethodsAndParametersByName) {
  EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"job.begin"})"), json_rpc::kMethodNotFound);
  const json answer =
      reply(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":{"seq":1,"part_id":"p","recip":"x"}})");
  EXPECT_EQ(answer["error"]["code"], json_rpc::kInvalidParams);
  EXPECT_NE(answer["error"]["message"].get<std::string>().find("recip"), std::string::npos);
  EXPECT_EQ(answer["error"]["data"], (json{{"error", "invalid_params"}, {"retry", false}}));
  EXPECT_EQ(service_.starts, 0);
}

TEST_F(ADispatcher, TellsAMisspeltParameterBesideTheOneThatIsMissing) {
  const json answer = reply(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":{"seq":1,"partid":"p"}})");
  const auto message = answer["error"]["message"].get<std::string>();
  EXPECT_NE(message.find("'part_id'"), std::string::npos) << message;
  EXPECT_NE(message.find("'partid'"), std::string::npos) << message;
}

TEST_F(ADispatcher, RefusesWrongTypesAndRanges) {
  for (const char* params :
       {R"({"seq":"1","part_id":"p"})", R"({"seq":1,"part_id":2})", R"({"seq":1})", R"({"part_id":"p"})",
        R"({"seq":0,"part_id":"p"})", R"({"seq":-1,"part_id":"p"})", R"({"seq":1.5,"part_id":"p"})",
        R"({"seq":9007199254740992,"part_id":"p"})", R"({"seq":1,"part_id":""})", R"({"seq":1,"part_id":"umläut"})",
        "[1,\"p\",\"chapter\",4]"}) {
    EXPECT_EQ(error_of(std::string(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":)") + params + "}"),
              json_rpc::kInvalidParams)
        << params;
  }
  EXPECT_EQ(service_.starts, 0);
}

TEST_F(ADispatcher, TakesWholeNumbersHoweverTheyAreWritten) {
  EXPECT_EQ(
      reply(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":{"seq":4711.0,"part_id":"p"}})")["result"]["seq"],
      4711);
  EXPECT_EQ(result_of("job.status", {{"seq", 4.711e3}})["job_id"], "job-4711");
}

TEST_F(ADispatcher, NamesTheRangeOfEveryNumberBeyondIt) {
  struct Case {
    const char* method;
    const char* params;
    const char* range;
  };
  for (const Case& beyond : {Case{"job.start", R"({"seq":0,"part_id":"p"})", "1..9007199254740991"},
                             Case{"job.start", R"({"seq":18446744073709551615,"part_id":"p"})", "1..9007199254740991"},
                             Case{"job.start", R"({"seq":1e300,"part_id":"p"})", "1..9007199254740991"},
                             Case{"job.status", R"({"seq":9007199254740992})", "1..9007199254740991"},
                             Case{"job.abort", R"({"seq":-1})", "1..9007199254740991"},
                             Case{"result.get", R"({"seq":0})", "1..9007199254740991"},
                             Case{"result.ack", R"({"seq":18446744073709551615})", "1..9007199254740991"},
                             Case{"job.wait", R"({"seq":1,"timeout_ms":30001})", "0..30000"},
                             Case{"camera.snap", R"({"exposure_us":-1})", "0.001..60000000"},
                             Case{"camera.preview", R"({"gain_db":101})", "0..100"},
                             Case{"camera.suggest_exposure", R"({"target":1})", "0.1..0.95"},
                             Case{"stage.move", R"({"z_um":1e7})", "-1000000..1000000"},
                             Case{"stage.autofocus", R"({"from_um":0,"to_um":1e9})", "-1000000..1000000"}}) {
    const json error = reply(std::string(R"({"jsonrpc":"2.0","id":1,"method":")") + beyond.method + R"(","params":)" +
                             beyond.params + "}")["error"];
    EXPECT_EQ(error["code"], json_rpc::kInvalidParams) << beyond.method << beyond.params;
    EXPECT_NE(error["message"].get<std::string>().find(beyond.range), std::string::npos) << error.dump();
  }
  EXPECT_EQ(service_.starts, 0);
  EXPECT_EQ(service_.task, nullptr);
}

TEST_F(ADispatcher, RepeatsNoMoreThan64BytesOfWhatItWasSent) {
  const std::string run(65, 'q');
  for (const std::string& line : {
           R"({"jsonrpc":"2.0","id":1,"method":")" + run + "\"}",
           R"({"jsonrpc":"2.0","id":")" + run + R"(","method":"system.ping"})",
           R"({"jsonrpc":"2.0","id":1,"method":"system.ping","params":{")" + run + "\":1}}",
           R"({"jsonrpc":"2.0","id":1,"method":"system.ping","params":{"t":")" + run + "\"}}",
           R"({"jsonrpc":"2.0","id":1,"method":"job.status","params":{"job_id":")" + run + "\"}}",
           R"({"jsonrpc":"2.0","id":1,"method":"recipe.get","params":{"id":")" + run + "\"}}",
           R"({"jsonrpc":"2.0","id":1,"method":"recipe.prepare","params":{"id":")" + run + "\"}}",
           R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":{"seq":1,"part_id":"p","recipe":")" + run + "\"}}",
           R"({"jsonrpc":"2.0","id":1,"method":"camera.snap","params":{"recipe":")" + run + "\"}}",
           "{\"" + run + "\":1,\"" + run + "\":2}",
           "\"" + run + run,
           "{\"a\":\"" + run + "\x01\"}",
           run,
       }) {
    const auto answer = dispatcher_.handle(line, caller_).reply;
    ASSERT_TRUE(answer.has_value()) << line;
    EXPECT_TRUE(json::parse(*answer).contains("error")) << *answer;
    EXPECT_EQ(answer->find(run), std::string::npos) << *answer;
  }
  EXPECT_EQ(service_.starts, 0);
}

TEST_F(ADispatcher, TakesParametersByPositionAndNullForNone) {
  const json started =
      reply(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[7,"part","chapter"]})")["result"];
  EXPECT_EQ(started["seq"], 7);
  EXPECT_EQ(started["job_id"], "job-7");
  EXPECT_TRUE(reply(R"({"jsonrpc":"2.0","id":1,"method":"system.ping","params":null})").contains("result"));
}

TEST_F(ADispatcher, ReturnsTheSameJobForTheSameSequenceNumber) {
  EXPECT_EQ(result_of("job.start", {{"seq", 3}, {"part_id", "p"}})["duplicate"], false);
  EXPECT_EQ(result_of("job.start", {{"seq", 3}, {"part_id", "p"}})["duplicate"], true);
}

TEST_F(ADispatcher, CarriesTheNameTheRetryAndTheStateOfAnError) {
  service_.refusal = ErrorCode::kNotReady;
  const json error = reply(R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":[1,"p"]})")["error"];
  EXPECT_EQ(error["code"], 1001);
  EXPECT_EQ(error["data"]["error"], "not_ready");
  EXPECT_EQ(error["data"]["retry"], true);
  EXPECT_EQ(error["data"]["state"], "ready");
}

TEST_F(ADispatcher, NamesAJobByIdOrBySequenceNumberNotByBoth) {
  result_of("job.start", {{"seq", 3}, {"part_id", "p"}});
  EXPECT_EQ(result_of("job.status", {{"seq", 3}})["job_id"], "job-3");
  EXPECT_EQ(result_of("job.status", {{"job_id", "job-3"}})["seq"], 3);
  EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"job.status"})"), json_rpc::kInvalidParams);
  EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"job.status","params":{"seq":3,"job_id":"job-3"}})"),
            json_rpc::kInvalidParams);
  EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"job.status","params":{"seq":99}})"), 1007);
}

TEST_F(ADispatcher, WaitsForAJobToEnd) {
  result_of("job.start", {{"seq", 3}, {"part_id", "p"}});
  const Handled handled = dispatcher_.handle(
      R"({"jsonrpc":"2.0","id":9,"method":"job.wait","params":{"seq":3,"timeout_ms":100}})", caller_);
  ASSERT_TRUE(handled.waiting.has_value());
  EXPECT_FALSE(handled.reply.has_value());
  EXPECT_FALSE(dispatcher_.resume(*handled.waiting, false).has_value());
  const json late = json::parse(dispatcher_.resume(*handled.waiting, true).value());
  EXPECT_EQ(late["result"]["done"], false);
  service_.change({3}, [](JobStatus& job) { job.state = JobState::kCompleted; });
  const json ended = json::parse(dispatcher_.resume(*handled.waiting, false).value());
  EXPECT_EQ(ended["id"], 9);
  EXPECT_EQ(ended["result"]["done"], true);
}

TEST_F(ADispatcher, RefusesWaitsItCannotKeep) {
  result_of("job.start", {{"seq", 3}, {"part_id", "p"}});
  for (const char* params :
       {R"({"seq":3,"timeout_ms":30001})", R"({"seq":3,"timeout_ms":-1})", R"({"seq":3,"until":"noon"})"}) {
    EXPECT_EQ(error_of(std::string(R"({"jsonrpc":"2.0","id":1,"method":"job.wait","params":)") + params + "}"),
              json_rpc::kInvalidParams);
  }
  EXPECT_EQ(error_of(R"({"jsonrpc":"2.0","id":1,"method":"job.wait","params":{"seq":4}})"), 1007);
}

TEST_F(ADispatcher, KeepsRepliesWithinWhatPlcsCanTake) {
  const std::string client(32, 'c');
  const ResultData sample = test::sample_result();
  service_.result = result_json_text(evaluate(sample, test::summary_of(sample.map)));
  result_of("job.start", {{"seq", 3}, {"part_id", std::string(64, '"')}, {"client", client}});  // two bytes each
  service_.change({3, client}, [](JobStatus& job) {
    job.state = JobState::kCompleted;
    job.error_message = std::string(5000, '"');
  });
  const auto size = [&](const char* method, const json& params) {
    return dispatcher_
        .handle(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump(), caller_)
        .reply->size();
  };
  EXPECT_LE(size("result.get", {{"seq", 3}, {"client", client}}), 440U);
  EXPECT_LE(size("result.next", json::object()), 440U);
  EXPECT_LE(size("result.get", {{"seq", 3}, {"format", "full"}, {"client", client}}), 1400U);
  EXPECT_LE(size("job.status", {{"seq", 3}, {"client", client}}), 1400U);
  EXPECT_LE(size("system.state", json::object()), 1400U);
}

TEST_F(ADispatcher, HandsOutResultsUntilTheyAreAcknowledged) {
  EXPECT_EQ(result_of("result.next")["job_id"], "");
  result_of("job.start", {{"seq", 3}, {"part_id", "p"}});
  service_.change({3}, [](JobStatus& job) { job.state = JobState::kCompleted; });
  const json result = result_of("result.next");
  EXPECT_EQ(result["seq"], 3);
  EXPECT_EQ(result["valid_fraction"], 0.97);
  EXPECT_EQ(result["height_min_um"], -1.25);
  EXPECT_EQ(result_of("result.ack", {{"seq", 3}})["remaining"], 0);
  EXPECT_EQ(result_of("result.next")["job_id"], "");
}

TEST_F(ADispatcher, AnswersInAscii) {
  const auto answer =
      dispatcher_.handle("{\"jsonrpc\":\"2.0\",\"id\":\"\xc3\xa4\",\"method\":\"system.ping\"}", caller_).reply;
  ASSERT_TRUE(answer.has_value());
  for (const char c : *answer) EXPECT_GE(c, ' ');
}

TEST_F(ADispatcher, DescribesEveryMethod) {
  const json methods = result_of("rpc.discover")["methods"];
  std::set<std::string> names;
  for (const auto& method : methods) names.insert(method["name"]);
  EXPECT_EQ(names.size(), dispatcher_.methods().size());
  for (const char* name : {"system.ping", "system.info", "system.state", "stage.accuracy", "recipe.list", "recipe.get",
                           "recipe.prepare", "job.start", "job.status", "job.latest", "job.list", "job.wait",
                           "job.abort", "result.get", "result.next", "result.ack"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(RpcErrors, GivesEveryErrorItsOwnPositiveCode) {
  std::set<int> codes;
  for (int i = 0; i <= static_cast<int>(kLastErrorCode); ++i) {
    const auto code = static_cast<ErrorCode>(i);
    if (code == ErrorCode::kInternal) continue;
    const int wire = rpc_error(code).code;
    EXPECT_GT(wire, 1000) << error_name(code);
    EXPECT_TRUE(codes.insert(wire).second) << error_name(code) << " shares " << wire;
    EXPECT_EQ(error_from_name(error_name(code)), code);
  }
  EXPECT_EQ(rpc_error(ErrorCode::kInternal).code, json_rpc::kInternalError);
}

}  // namespace
}  // namespace fvd
