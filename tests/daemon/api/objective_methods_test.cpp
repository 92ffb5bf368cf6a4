/// What the methods of objectives answer and refuse, and the temperature that comes with a job.

#include "gtest/gtest.h"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

std::string request(const std::string& method, const json& params) {
  return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump();
}

TEST_F(ADispatcher, KnowsObjectivesAndTheOneThatIsConfirmed) {
  const json before = result_of("objective.list");
  EXPECT_EQ(before["objective"], "");
  EXPECT_FALSE(before.contains("person"));
  EXPECT_EQ(before["objectives"][0],
            json::parse(R"({"name": "20x", "na": 0.4, "magnification": 20.0, "working_distance_mm": 11.0})"));
  EXPECT_EQ(before["objectives"][1]["min_um"], -100.0);
  EXPECT_EQ(result_of("system.state")["objective"], "");

  const json confirmed = result_of("objective.confirm", {{"name", "50x"}, {"person", "Anna"}});

  EXPECT_EQ(confirmed, json::parse(R"({"objective": "50x", "person": "Anna",
                                       "confirmed_utc": "2026-11-29T10:00:00.000Z"})"));
  EXPECT_EQ(result_of("objective.list")["person"], "Anna");
  EXPECT_EQ(result_of("system.state")["objective"], "50x");
}

TEST_F(ADispatcher, TakesTheClientForThePersonWhereNoneIsNamed) {
  EXPECT_EQ(result_of("objective.confirm", {{"name", "50x"}})["person"], "plc");
  EXPECT_EQ(result_of("objective.confirm", {{"name", "50x"}, {"client", "cell-7"}})["person"], "cell-7");
}

TEST_F(ADispatcher, RefusesWhatIsNoConfirmation) {
  EXPECT_EQ(error_of(request("objective.confirm", json::object())), -32602);
  EXPECT_EQ(error_of(request("objective.confirm", {{"name", 50}})), -32602);
  EXPECT_EQ(error_of(request("objective.confirm", {{"name", std::string(65, 'x')}})), -32602);
  EXPECT_EQ(error_of(request("objective.confirm", {{"name", "50x"}, {"person", "a\nb"}})), -32602);
  EXPECT_EQ(error_of(request("objective.confirm", {{"name", "50x"}, {"person", std::string(65, 'x')}})), -32602);
  EXPECT_EQ(error_of(request("objective.confirm", {{"name", "50x"}, {"client", "no name"}})), -32602);
  EXPECT_EQ(error_of(request("objective.list", {{"name", "50x"}})), -32602);
  EXPECT_GT(error_of(request("objective.confirm", {{"name", "5x"}})), 0);
  service_.objectives.busy = true;
  EXPECT_EQ(error_of(request("objective.confirm", {{"name", "50x"}})), 1002);
  EXPECT_FALSE(service_.objectives.confirmed.has_value());
}

TEST_F(ADispatcher, TakesNoConfirmationWhoseAnswerNobodyReads) {
  (void)dispatcher_.handle(
      R"({"jsonrpc": "2.0", "method": "objective.confirm", "params": {"name": "50x", "person": "Anna"}})", caller_);
  (void)dispatcher_.handle(R"({"jsonrpc": "2.0", "method": "calibrate.accept",
                               "params": {"study": "study-0001", "person": "anna", "renew_by": "2027-11-29"}})",
                           caller_);

  EXPECT_FALSE(service_.objectives.confirmed.has_value());
  EXPECT_FALSE(service_.studies.accepted.has_value());
}

TEST_F(ADispatcher, TakesATemperatureWithAJob) {
  result_of("job.start", {{"seq", 1}, {"part_id", "p"}, {"temperature_c", 20.1}});
  result_of("job.start", {{"seq", 2}, {"part_id", "p"}});
  result_of("job.start", {{"seq", 3}, {"part_id", "p"}, {"temperature_c", -50}});

  EXPECT_EQ(service_.job(ClientSeq{1}).request.temperature_c, 20.1);
  EXPECT_EQ(service_.job(ClientSeq{2}).request.temperature_c, std::nullopt);
  EXPECT_EQ(service_.job(ClientSeq{3}).request.temperature_c, -50.0);
}

TEST_F(ADispatcher, RefusesATemperatureThatIsNone) {
  for (const json& wrong : {json(-50.01), json(100.01), json("20"), json(nullptr), json(true), json::array({20})}) {
    EXPECT_EQ(error_of(request("job.start", {{"seq", 1}, {"part_id", "p"}, {"temperature_c", wrong}})), -32602)
        << wrong.dump();
  }
  EXPECT_EQ(service_.starts, 0);
}

}  // namespace
}  // namespace fvd
