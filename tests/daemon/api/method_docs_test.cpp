/// The descriptions of the methods against what the methods do, and against the README.

#include "daemon/api/method_docs.hpp"

#include <cstdlib>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "config/field_reader.hpp"
#include "daemon/api/dispatcher.hpp"
#include "daemon/api/error_meanings.hpp"
#include "daemon/api/methods/methods.hpp"
#include "tests/daemon/api/fake_job_service.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

class EveryMethod : public testing::Test {
 protected:
  /// The reply's result, that of a command once it has ended with `task_result`.
  json result_of(const std::string& method, const json& params, const std::string& task_result = "") {
    const json request{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}};
    Handled handled = dispatcher_.handle(request.dump(), caller_);
    if (handled.waiting) {
      if (!task_result.empty()) {
        std::get<std::shared_ptr<DeviceTask>>(handled.waiting->until.awaited)->end({task_result, std::nullopt, {}});
      }
      handled.reply = dispatcher_.resume(*handled.waiting, true);
    }
    const json answer = json::parse(handled.reply.value());
    EXPECT_TRUE(answer.contains("result")) << answer.dump();
    return answer.value("result", json());
  }

  FakeJobService service_;
  Caller caller_{.who = {"test", Role::kAdminister}};
  Dispatcher dispatcher_{all_methods(service_.services()), service_.services()};
};

/// A call, and where its answer is a task's what the task tells.
struct Case {
  const char* method;
  json params;
  std::string task_result = "";
};

std::vector<Case> study_cases() {
  const std::string study = R"({"study":{},"directory":"/x","report":"/x/report.pdf"})";
  const json jobs{{"jobs", {"a", "b"}}};
  const json step{{"job", "a"}, {"measurement", "step"}, {"reference_um", 50}, {"u_reference_um", 0.02}};
  const json at_z{{"job", "a"}, {"measurement", "step"}, {"z_um", 5}};
  const json type1{{"jobs", {"a", "b"}}, {"measurement", "step"}, {"reference", 50}, {"tolerance", 1}};
  const json texture{{"jobs", {"a", "b"}}, {"measurement", "texture"}};
  const json rr{{"jobs", {"a", "b"}}, {"measurement", "step"}, {"parts", 2}, {"operators", 1}, {"trials", 2}};
  return {Case{"verify.noise", jobs, study},
          Case{"calibrate.noise", jobs, study},
          Case{"verify.flatness", jobs, study},
          Case{"calibrate.flatness", jobs, study},
          Case{"verify.step", {{"steps", {step}}}, study},
          Case{"calibrate.z", {{"steps", {step}}}, study},
          Case{"verify.linearity", {{"steps", {at_z, at_z}}}, study},
          Case{"calibrate.lateral", {{"job", "a"}, {"grid_pitch_um", 40}}, study},
          Case{"verify.resolution", {{"job", "a"}, {"artefact", "star"}}, study},
          Case{"verify.sphere", {{"job", "a"}, {"radius_um", 500}}, study},
          Case{"verify.hysteresis", {{"up", "a"}, {"down", "b"}}, study},
          Case{"verify.texture", texture, study},
          Case{"calibrate.texture", texture, study},
          Case{"gauge.type1", type1, study},
          Case{"gauge.rr", rr, study},
          Case{"gauge.capability", {{"type1", "study-0001"}, {"rr", "study-0002"}}, study}};
}

TEST_F(EveryMethod, AnswersAsItIsDescribed) {
  ASSERT_FALSE(result_of("job.start", {{"seq", 1}, {"part_id", "p"}}).is_null());
  const json nothing = json::object();
  const json one{{"seq", 1}};
  const std::string grey = R"({"min":0,"max":9})";
  std::vector<Case> cases{
      {"system.ping", {{"t", {1, "x"}}}},
      {"system.ping", nothing},
      {"system.info", nothing},
      {"system.state", nothing},
      {"system.health", nothing},
      {"rpc.discover", nothing},
      {"recipe.list", nothing},
      {"recipe.get", {{"id", "chapter"}}},
      {"recipe.prepare", {{"id", "chapter"}}},
      {"recipe.check", {{"text", "{}"}}},
      {"recipe.check", {{"text", "[]"}, {"id", "part"}}},
      {"recipe.save", {{"id", "chapter"}, {"text", "{}"}, {"base_version", 3}, {"author", "anna"}}},
      {"recipe.versions", {{"id", "chapter"}}},
      {"recipe.restore", {{"id", "chapter"}, {"version", 1}, {"base_version", 3}, {"author", "anna"}}},
      {"job.start", {{"seq", 1}, {"part_id", "p"}}},
      {"job.status", one},
      {"job.wait", one},
      {"job.abort", one},
      {"job.latest", nothing},
      {"job.list", nothing},
      {"value.list", {{"measurement", "step"}, {"value", "height_um"}}},
      {"alarm.list", nothing},
      {"alarm.acknowledge", {{"number", 1}}},
      {"result.get", one},
      {"result.next", nothing},
      {"result.evaluate",
       {{"seq", 1}, {"recipe", "chapter"}},
       R"({"id":"j-e1","job_id":"j","recipe":"chapter","verdict":null,"directory":"/r/j-e1"})"},
      {"stage.accuracy", nothing},
      {"objective.list", nothing},
      {"objective.confirm", {{"name", "50x"}, {"person", "Anna"}}},
      {"objective.list", nothing},
      {"camera.snap", nothing,
       R"({"path":"/x.png","width_px":1,"height_px":1,"bits":8,"exposure_us":1,"gain_db":0,"z_um":1,"grey":)" + grey +
           "}"},
      {"camera.preview", nothing,
       R"({"seq":1,"width_px":1,"height_px":1,"z_um":0,"focus":1,"saturated_fraction":0,"png_base64":"aa"})"},
      {"camera.suggest_exposure", nothing, R"({"exposure_us":1,"reached":true,"looks":3,"grey":)" + grey + "}"},
      {"stage.autofocus", {{"from_um", 0}, {"to_um", 10}}, R"({"z_um":5,"focus":9,"curve_um_focus":[[0,1]]})"},
      {"stage.home", nothing, R"({"z_um":0,"homed":true})"},
      {"stage.move", {{"z_um", 1}}, R"({"z_um":1})"},
      {"stage.jog", {{"direction", "up"}, {"speed_um_per_s", 10}}},
      {"stage.stop", nothing},
      {"error.reset", nothing, R"({"z_um":1,"homed":true})"},
      {"session.info", nothing},
      {"control.state", nothing},
      {"control.acquire", {{"owner", "test"}}},
      {"control.state", nothing},
      {"control.release", nothing},
      {"audit.list", nothing},
      {"study.list", nothing},
      {"study.get", {{"id", "study-0001"}}},
      {"calibration.get", nothing},
      {"calibrate.accept", {{"study", "study-0001"}, {"person", "anna"}, {"renew_by", "2027-11-29"}}}};
  for (const Case& call : study_cases()) cases.push_back(call);
  // access_methods_test and profile_methods_test have the last ones.
  std::set<std::string> seen{"result.ack", "session.login", "result.profile"};
  const auto check = [&](const Case& call) {
    seen.insert(call.method);
    const json result = result_of(call.method, call.params, call.task_result);
    Problems problems;
    FieldReader reader(result, problems, "/result");
    dispatcher_.methods().at(call.method).about.result(reader);
    reader.finish();
    EXPECT_TRUE(problems.empty()) << to_text(problems, call.method) << result.dump();
  };
  for (const Case& call : cases) check(call);
  service_.change({1}, [](JobStatus& job) { job.state = JobState::kCompleted; });
  service_.stage_steps = StepHistorySummary{};
  for (const Case& call : {Case{"result.get", one}, Case{"result.get", {{"seq", 1}, {"format", "full"}}},
                           Case{"result.next", nothing}, Case{"stage.accuracy", nothing}, Case{"result.ack", one}}) {
    check(call);
  }
  EXPECT_EQ(seen.size(), dispatcher_.methods().size()) << "a method is missing in this test";
}

TEST_F(EveryMethod, StandsInOpenRpcWithAllThatIsKnownOfIt) {
  const json document = openrpc_document(dispatcher_.methods());
  for (const json& method : document["methods"]) {
    EXPECT_FALSE(method["summary"].get<std::string>().empty()) << method["name"];
    for (const json& param : method["params"]) {
      EXPECT_FALSE(param["description"].get<std::string>().empty()) << method["name"] << param;
    }
    EXPECT_FALSE(method["result"]["schema"]["properties"].empty()) << method["name"];
    EXPECT_TRUE(method["x-role"] == "none" || role_from_name(method["x-role"].get<std::string>())) << method["name"];
  }
  const auto start = std::find_if(document["methods"].begin(), document["methods"].end(),
                                  [](const json& method) { return method["name"] == "job.start"; });
  ASSERT_NE(start, document["methods"].end());
  EXPECT_EQ((*start)["x-moves-stage"], true);
  EXPECT_EQ((*start)["x-may-wait"], false);
  EXPECT_EQ((*start)["params"][0]["name"], "seq");
  EXPECT_EQ((*start)["params"][0]["required"], true);
  EXPECT_EQ((*start)["params"][0]["schema"]["maximum"], kLargestExactInteger);
  EXPECT_EQ((*start)["params"][3]["schema"]["default"], "plc");
}

TEST_F(EveryMethod, FailsWithErrorsThatTheTableExplains) {
  for (int i = 0; i <= static_cast<int>(kLastErrorCode); ++i) {
    const auto code = static_cast<ErrorCode>(i);
    EXPECT_FALSE(error_meaning(code).empty()) << error_name(code);
  }
  const std::string table = methods_markdown(dispatcher_.methods());
  for (const char* row :
       {"| 1142 | region_outside |  | ", "| 1143 | calibration_missing |", "| 1145 | verdict_uncertain |",
        "| 1146 | objective_mismatch |", "| 1147 | study_refused |", "| 1141 | evaluation_invalid |"}) {
    EXPECT_NE(table.find(row), std::string::npos) << row;
  }
}

/// What the operator page's types are made of: a key that is renamed here breaks the page's build. With
/// FVD_WRITE_TABLES=1 in the environment the file is written instead of compared.
TEST_F(EveryMethod, StandsInTheDescriptionThatThePageIsBuiltWith) {
  const std::filesystem::path file = FVD_SOURCE_DIR "/daemon/web/openrpc.json";
  nlohmann::ordered_json document = openrpc_document(dispatcher_.methods());
  document["info"].erase("version");
  const std::string wanted = document.dump(1) + "\n";
  if (std::getenv("FVD_WRITE_TABLES") != nullptr) std::ofstream(file) << wanted;
  EXPECT_TRUE(test::read_text(file) == wanted)
      << file << " is not what rpc.discover says: run api_test with FVD_WRITE_TABLES=1";
}

/// With FVD_WRITE_TABLES=1 in the environment the README is written instead of compared.
TEST_F(EveryMethod, StandsInTheReadme) {
  const std::filesystem::path file = FVD_SOURCE_DIR "/daemon/README.md";
  const std::string readme = test::read_text(file);
  const std::string begin = "<!-- methods: begin (FVD_WRITE_TABLES=1 api_test) -->\n";
  const std::string end = "<!-- methods: end -->\n";
  const auto from = readme.find(begin);
  const auto to = readme.find(end);
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  const std::string wanted =
      readme.substr(0, from + begin.size()) + methods_markdown(dispatcher_.methods()) + readme.substr(to);
  if (std::getenv("FVD_WRITE_TABLES") != nullptr) std::ofstream(file) << wanted;
  EXPECT_TRUE(test::read_text(file) == wanted)
      << file << " does not hold the tables of the methods: run api_test with FVD_WRITE_TABLES=1";
}

}  // namespace
}  // namespace fvd
