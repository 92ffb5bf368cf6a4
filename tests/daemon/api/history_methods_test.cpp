/// Lists of jobs and values: what they ask the history for, what they tell, and what they refuse.

#include <limits>

#include "daemon/api/rpc_errors.hpp"
#include "gmock/gmock.h"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

std::string call_of(const std::string& method, const json& params) {
  return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump();
}

class AListing : public ADispatcher {
 protected:
  std::string refusal_of(const std::string& method, const json& params) {
    const json answer = reply(call_of(method, params));
    EXPECT_EQ(answer.value("/error/code"_json_pointer, 0), json_rpc::kInvalidParams) << params << answer;
    return answer.value("/error/message"_json_pointer, "");
  }
  const FakeHistory::Asked& asked_with(const json& params) {
    result_of("job.list", params);
    EXPECT_TRUE(service_.history.asked.has_value());
    return *service_.history.asked;
  }
  const json step_{{"measurement", "step"}, {"value", "height_um"}};
};

TEST_F(AListing, AsksForTheNewestFiftyJobs) {
  const FakeHistory::Asked asked = asked_with(json::object());

  EXPECT_EQ(asked.before, 0);
  EXPECT_EQ(asked.most, 50);
  EXPECT_EQ(asked.filter.part_id + asked.filter.recipe + asked.filter.text, "");
  EXPECT_EQ(asked.filter.from_utc + asked.filter.to_utc, "");
  EXPECT_FALSE(asked.filter.verdict);
  EXPECT_FALSE(asked.filter.state);
}

TEST_F(AListing, PassesTheWholeFilterOn) {
  const JobFilter filter = asked_with({{"most", 500},
                                       {"part_id", "P-08"},
                                       {"recipe", "groove"},
                                       {"verdict", "uncertain"},
                                       {"state", "aborted"},
                                       {"from_utc", "2026-11-30T10:00:00Z"},
                                       {"to_utc", "2026-11-30T11:00:00Z"},
                                       {"text", "Camera"}})
                               .filter;

  EXPECT_EQ(service_.history.asked->most, 500);
  EXPECT_EQ(filter.part_id, "P-08");
  EXPECT_EQ(filter.recipe, "groove");
  EXPECT_EQ(filter.verdict, "uncertain");
  EXPECT_EQ(filter.state, JobState::kAborted);
  EXPECT_EQ(filter.from_utc, "2026-11-30T10:00:00.000Z");
  EXPECT_EQ(filter.to_utc, "2026-11-30T11:00:00.999Z") << "the whole of the last second";
  EXPECT_EQ(filter.text, "Camera");
  EXPECT_EQ(asked_with({{"verdict", "none"}}).filter.verdict, "") << "nothing was judged";
  EXPECT_EQ(asked_with({{"from_utc", "2026-11-30T10:00:00.123Z"}}).filter.from_utc, "2026-11-30T10:00:00.123Z");
  for (const JobState state : {JobState::kProcessing, JobState::kCompleted, JobState::kAborted, JobState::kFailed}) {
    EXPECT_EQ(asked_with({{"state", job_state_name(state)}}).filter.state, state);
  }
}

TEST_F(AListing, TellsEachJobAndWhereItGoesOn) {
  JobStatus passed;
  passed.job_id = "20261130T100000Z-00003-000042";
  passed.request = {4711, "P-0815", "groove", "plc"};
  passed.state = JobState::kCompleted;
  passed.verdict = "pass";
  passed.ended_utc = "2026-11-30T10:00:05.250Z";
  JobStatus failed = passed;
  failed.request.part_id = "<script>alert(1)</script>\"";
  failed.state = JobState::kFailed;
  failed.verdict = "";
  failed.error = ErrorCode::kCameraFramesLost;
  JobStatus running;
  running.job_id = "J43";
  service_.history.page = {{running, passed, failed}, 41};

  const json told = result_of("job.list");

  ASSERT_EQ(told["jobs"].size(), 3U);
  EXPECT_EQ(told["jobs"][1], json::parse(R"({"job_id": "20261130T100000Z-00003-000042", "seq": 4711, "client": "plc",
      "part_id": "P-0815", "recipe": "groove", "state": "completed", "verdict": "pass",
      "ended_utc": "2026-11-30T10:00:05.250Z", "error": ""})"));
  EXPECT_EQ(told["jobs"][0]["state"], "processing");
  EXPECT_EQ(told["jobs"][0]["ended_utc"], "");
  EXPECT_EQ(told["jobs"][2]["verdict"], nullptr);
  EXPECT_EQ(told["jobs"][2]["error"], error_name(ErrorCode::kCameraFramesLost));
  EXPECT_EQ(told["jobs"][2]["part_id"], failed.request.part_id) << "whoever shows it makes it harmless";
  const auto cursor = told["next"].get<std::string>();
  EXPECT_FALSE(cursor.empty());
  EXPECT_EQ(asked_with({{"before", cursor}}).before, 41) << "the cursor comes back as it went";
  EXPECT_EQ(asked_with({{"before", ""}}).before, 0);
  service_.history.page.next = 0;
  EXPECT_EQ(result_of("job.list")["next"], "");
  for (const char* verdict : {"pass", "fail", "uncertain", "invalid"}) {
    service_.history.page.jobs[0].verdict = verdict;
    EXPECT_EQ(result_of("job.list")["jobs"][0]["verdict"], verdict);
  }
}

TEST_F(AListing, RefusesWhatIsNoCursorAndSaysWhatToDo) {
  service_.history.page.next = 41;
  const auto cursor = result_of("job.list")["next"].get<std::string>();
  for (const std::string& wrong :
       {std::string("41"), std::string("x"), cursor + " ", " " + cursor, cursor + "x", "0" + cursor,
        cursor.substr(0, cursor.size() - 2) + "041", cursor.substr(0, cursor.size() - 2) + "0",
        cursor.substr(0, cursor.size() - 2) + "-1", cursor.substr(0, cursor.size() - 2),
        cursor.substr(0, cursor.size() - 2) + "9223372036854775808", std::string("\0", 1), std::string("\xc3\xa4")}) {
    EXPECT_THAT(refusal_of("job.list", {{"before", wrong}}),
                AllOf(HasSubstr("before"), HasSubstr("`next`"), HasSubstr("leave")))
        << wrong;
  }
  refusal_of("job.list", {{"before", std::string(1000, '1')}});
  refusal_of("job.list", {{"before", 41}});
}

TEST_F(AListing, RefusesWhatIsNoFilter) {
  for (const json& wrong :
       {json{{"most", 0}}, json{{"most", 501}}, json{{"most", 1.5}}, json{{"verdict", "ok"}}, json{{"verdict", ""}},
        json{{"verdict", nullptr}}, json{{"state", "done"}}, json{{"state", ""}}, json{{"part_id", 7}},
        json{{"part_id", std::string(65, 'p')}}, json{{"recipe", std::string(65, 'r')}},
        json{{"text", std::string(65, 't')}}, json{{"text", nullptr}}, json{{"unknown", 1}}}) {
    EXPECT_NE(refusal_of("job.list", wrong), "") << wrong;
  }
  EXPECT_FALSE(service_.history.asked);
}

TEST_F(AListing, RefusesATimeThatIsNone) {
  for (const char* wrong :
       {"2026-11-30", "now", "2026-11-30 10:00:00Z", "2026-11-30T10:00:00", "2026-11-30T10:00:00+01:00",
        "2026-11-30T10:00:00.1Z", "2026-13-01T10:00:00Z", "2026-00-01T10:00:00Z", "2026-02-29T10:00:00Z",
        "2026-11-31T10:00:00Z", "2026-11-30T24:00:00Z", "2026-11-30T10:60:00Z", "2026-11-30T10:00:61Z",
        "2026-11-30T10:00:0xZ", "2026-11-30T10:00:00.00xZ", "-026-11-30T10:00:00Z", "20\xc3\xa4-11-30T10:00:00Z"}) {
    for (const char* name : {"from_utc", "to_utc"}) {
      EXPECT_THAT(refusal_of("job.list", {{name, wrong}}), AllOf(HasSubstr(name), HasSubstr("2026-11-30T10:00:00Z")))
          << wrong;
    }
  }
  EXPECT_FALSE(service_.history.asked);
  EXPECT_EQ(asked_with({{"to_utc", "2028-02-29T23:59:60Z"}}).filter.to_utc, "2028-02-29T23:59:60.999Z");
}

TEST_F(AListing, TellsAValueFromJobToJob) {
  service_.history.points = {
      {"J1", "a", "2026-11-30T10:00:00.000Z", {"step", "height_um", 50.01, 0.01, 0.02, 49.0, 51.0, "pass"}},
      {"J2", "b", "2026-11-30T11:00:00.000Z", {"step", "height_um", {}, {}, {}, {}, {}, ""}},
      {"J3",
       "c",
       "2026-11-30T12:00:00.000Z",
       {"step", "height_um", -std::numeric_limits<double>::max(), 1e-300, {}, 49.0, {}, "invalid"}}};

  const json points = result_of("value.list", step_)["points"];

  EXPECT_EQ(points[0], json::parse(R"({"job_id": "J1", "part_id": "a", "ended_utc": "2026-11-30T10:00:00.000Z",
      "value": 50.01, "u": 0.01, "U": 0.02, "lower": 49.0, "upper": 51.0, "verdict": "pass"})"));
  for (const char* key : {"value", "u", "U", "lower", "upper", "verdict"}) EXPECT_EQ(points[1][key], nullptr) << key;
  EXPECT_EQ(points[2]["lower"], 49.0);
  EXPECT_EQ(points[2]["upper"], nullptr);
  EXPECT_EQ(service_.history.asked_value->measurement, "step");
  EXPECT_EQ(service_.history.asked_value->value, "height_um");
  EXPECT_EQ(service_.history.asked_value->recipe, "");
  EXPECT_EQ(service_.history.asked_value->most, 100);
}

TEST_F(AListing, SaysThatOlderJobsWereNotLookedAt) {
  EXPECT_EQ(result_of("value.list", step_)["searched_all"], true);
  service_.history.searched_all = false;
  EXPECT_EQ(result_of("value.list", step_)["searched_all"], false);
  service_.history.page = {{}, 80001};
  const json part = result_of("job.list", {{"text", "nowhere"}});
  EXPECT_EQ(part["jobs"], json::array());
  EXPECT_EQ(asked_with({{"before", part["next"]}}).before, 80001) << "a part without jobs is not the last";
}

TEST_F(AListing, RefusesAValueThatIsNotNamed) {
  const auto changed = [this](const char* key, const json& value) {
    json params = step_;
    params[key] = value;
    return params;
  };
  for (const json& wrong :
       {json::object(), json{{"measurement", "step"}}, json{{"value", "height_um"}}, changed("most", 1),
        changed("most", 2001), changed("measurement", std::string(65, 'm')), changed("value", 5),
        changed("value", std::string(129, 'v')), changed("recipe", 5), changed("before", "x")}) {
    EXPECT_NE(refusal_of("value.list", wrong), "") << wrong;
  }
  EXPECT_FALSE(service_.history.asked_value);
  for (const int most : {2, 2000}) result_of("value.list", changed("most", most));
  EXPECT_EQ(service_.history.asked_value->most, 2000);
  result_of("value.list", changed("value", std::string(128, 'v')));
  EXPECT_EQ(service_.history.asked_value->value.size(), 128U);
}

TEST_F(AListing, TellsOfADatabaseThatCannotBeRead) {
  service_.history.failure = Error(ErrorCode::kDatabase, "the disk is gone");
  EXPECT_EQ(error_of(call_of("job.list", json::object())), 1133);
  EXPECT_EQ(error_of(call_of("value.list", step_)), 1133);
}

TEST_F(AListing, IsNeverDoneOnTheNetworkThread) {
  for (const std::string& line :
       {call_of("job.list", json::object()), call_of("value.list", step_), call_of("alarm.list", json::object())}) {
    EXPECT_FALSE(dispatcher_.try_handle(line, caller_)) << line;
  }
}

TEST_F(AListing, IsDescribedWithTheTypesOfItsRows) {
  const json methods = result_of("rpc.discover")["methods"];
  const auto schema_of = [&methods](const char* name) {
    const auto found =
        std::find_if(methods.begin(), methods.end(), [name](const json& it) { return it["name"] == name; });
    return (*found)["result"]["schema"]["properties"];
  };
  const json row = schema_of("job.list")["jobs"]["items"];
  EXPECT_EQ(row["properties"]["verdict"]["enum"], (json{"pass", "fail", "uncertain", "invalid", nullptr}));
  EXPECT_EQ(row["properties"]["ended_utc"]["x-unit"], "ISO 8601");
  EXPECT_EQ(row["required"].size(), row["properties"].size());
  EXPECT_FALSE(row["properties"]["seq"].contains("default"));
  const json point = schema_of("value.list")["points"]["items"]["properties"];
  EXPECT_EQ(point["U"]["type"], (json{"number", "null"}));
  EXPECT_FALSE(point["U"].contains("maximum")) << "any number";
  EXPECT_EQ(schema_of("alarm.list")["alarms"]["maxItems"], 200);
}

}  // namespace
}  // namespace fvd
