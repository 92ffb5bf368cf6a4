/// What the methods of studies and constants answer and refuse.

#include "daemon/api/rpc_errors.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

std::string line(const std::string& method, const json& params) {
  return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump();
}

TEST_F(ADispatcher, AnswersAStudyWhenItIsThere) {
  const json step{{"job", "a"}, {"measurement", "step"}, {"reference_um", 50}, {"u_reference_um", 0.02}};

  const Handled handled = dispatcher_.handle(
      line("calibrate.z", {{"steps", {step}}, {"u_common_relative", 1e-4}, {"person", "anna"}}), caller_);

  ASSERT_TRUE(handled.waiting);
  ASSERT_TRUE(service_.studies.begun);
  EXPECT_EQ(service_.studies.begun->kind, "calibrate.z");
  EXPECT_EQ(service_.studies.begun->person, "anna");
  const auto& request = std::get<StepRequest>(service_.studies.begun->input);
  EXPECT_EQ(request.steps.at(0).what.value, "height_um");
  EXPECT_EQ(request.u_common_relative, 1e-4);
  EXPECT_FALSE(dispatcher_.resume(*handled.waiting, false));
  service_.studies.task->end({"", ErrorCode::kStudyRefused, "job b has another size"});
  const auto reply = dispatcher_.resume(*handled.waiting, false);
  ASSERT_TRUE(reply);
  EXPECT_EQ(json::parse(*reply)["error"]["code"], 1147);
}

TEST_F(ADispatcher, RefusesAStudyOfWrongParameters) {
  const json jobs{{"jobs", {"a", "b"}}};
  const auto with = [&jobs](const char* key, const json& value) {
    json changed = jobs;
    changed[key] = value;
    return line("verify.noise", changed);
  };

  EXPECT_EQ(error_of(line("verify.noise", json::object())), json_rpc::kInvalidParams);
  EXPECT_EQ(error_of(with("jobs", {"a", "a"})), json_rpc::kInvalidParams) << "one job twice";
  EXPECT_EQ(error_of(with("jobs", {"a", 5})), json_rpc::kInvalidParams);
  EXPECT_EQ(error_of(with("region", {{"circle_um", {1, 2}}})), json_rpc::kInvalidParams);
  EXPECT_EQ(error_of(with("scans", 3)), json_rpc::kInvalidParams);
  EXPECT_FALSE(service_.studies.begun);
  service_.studies.busy = true;
  EXPECT_EQ(error_of(line("verify.noise", jobs)), 1002);
}

TEST_F(ADispatcher, TellsStudiesAndConstants) {
  const json list = result_of("study.list");
  EXPECT_EQ(list["studies"][0]["calibration"], "cal-0001");
  EXPECT_EQ(list["broken"][0]["id"], "study-0002");
  EXPECT_TRUE(result_of("study.list", {{"kind", "verify."}})["studies"].empty());
  EXPECT_EQ(error_of(line("study.get", {{"id", "study-0009"}})), 1147);
  EXPECT_EQ(result_of("study.get", {{"id", "study-0001"}})["report"], "/studies/study-0001/report.pdf");
  const json newest = result_of("calibration.get");
  EXPECT_EQ(newest["calibration"]["id"], "cal-0002");
  EXPECT_EQ(newest["lapsed"], json{"z"});
  EXPECT_EQ(newest["versions"], (json{"cal-0002", "cal-0001"}));
  EXPECT_EQ(result_of("calibration.get", {{"id", "cal-0001"}})["calibration"]["id"], "cal-0001");
  EXPECT_EQ(error_of(line("calibration.get", {{"objective", "50x"}})), 1143);
}

TEST_F(ADispatcher, AcceptsConstantsInSomebodysName) {
  json params{{"study", "study-0001"}, {"person", "anna"}, {"renew_by", "2027-11-29"}, {"certificate", "DKD-1"}};

  const json accepted = result_of("calibrate.accept", params);

  EXPECT_EQ(accepted["calibration"], "cal-0001");
  EXPECT_EQ(accepted["already"], false);
  EXPECT_EQ(service_.studies.accepted->certificate, "DKD-1");
  params.erase("person");
  EXPECT_EQ(error_of(line("calibrate.accept", params)), json_rpc::kInvalidParams);
}

}  // namespace
}  // namespace fvd
