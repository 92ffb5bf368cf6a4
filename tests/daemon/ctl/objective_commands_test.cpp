#include "daemon/ctl/objective_commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/ctl/exit_codes.hpp"
#include "tests/daemon/ctl/fake_rpc_server.hpp"
#include "tests/daemon/ctl/run_command.hpp"

namespace fvd::ctl {
namespace {

using fvd::test::Outcome;
using nlohmann::json;
using test::FakeRpcServer;
using testing::HasSubstr;

const json kTwenty{{"name", "20x"}, {"na", 0.4}, {"magnification", 20.0}, {"working_distance_mm", 11.0}};
const json kFifty{{"name", "50x"},    {"na", 0.55},     {"magnification", 50.0}, {"working_distance_mm", 3.1},
                  {"min_um", -150.0}, {"max_um", 120.0}};

Outcome ask(FakeRpcServer& server, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"--address", server.endpoint().text(), "objective"});
  return fvd::test::run_command(arguments);
}

TEST(FvdctlObjective, ListsThemWithTheOneThatIsConfirmed) {
  FakeRpcServer server({{"objective.list", FakeRpcServer::result({{"objectives", {kTwenty, kFifty}},
                                                                  {"objective", "50x"},
                                                                  {"person", "Anna"},
                                                                  {"confirmed_utc", "2026-11-29T10:00:00.000Z"}})}});

  const Outcome outcome = ask(server, {"list"});

  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(outcome.out,
            "20x  NA 0.4, 20x, 11 mm\n"
            "50x  NA 0.55, 50x, 3.1 mm, z from -150 um, z up to 120 um  confirmed\n");
  EXPECT_THAT(outcome.err, HasSubstr("confirmed by Anna, 2026-11-29T10:00:00.000Z"));
}

TEST(FvdctlObjective, SaysWhatToDoWhereNoneIsConfirmed) {
  FakeRpcServer server({{"objective.list", FakeRpcServer::result({{"objectives", {kTwenty}}, {"objective", ""}})}});

  const Outcome outcome = ask(server, {"list"});

  EXPECT_EQ(outcome.out, "20x  NA 0.4, 20x, 11 mm\n");
  EXPECT_THAT(outcome.err, HasSubstr("'fvdctl objective confirm NAME'"));
}

TEST(FvdctlObjective, SaysWhereTheConfigurationNamesNone) {
  FakeRpcServer server({{"objective.list", FakeRpcServer::result({{"objectives", json::array()}, {"objective", ""}})}});

  const Outcome outcome = ask(server, {"list"});

  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("names no objectives"));
}

TEST(FvdctlObjective, ConfirmsOneInAPersonsName) {
  FakeRpcServer server(
      {{"objective.confirm",
        FakeRpcServer::result({{"objective", "50x"}, {"person", "Anna"}, {"confirmed_utc", "2026-11-29"}})}});

  const Outcome outcome = ask(server, {"confirm", "50x", "--person", "Anna"});

  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(outcome.out, "50x confirmed by Anna\n");
  EXPECT_EQ(server.requests().at(0)["params"], json({{"name", "50x"}, {"person", "Anna"}}));
}

TEST(FvdctlObjective, NeedsAName) {
  for (const auto& arguments :
       std::vector<std::vector<std::string>>{{"objective"}, {"objective", "confirm"}, {"objective", "drop"}}) {
    EXPECT_EQ(fvd::test::run_command(arguments).code, kExitUsage) << testing::PrintToString(arguments);
  }
}

TEST(FvdctlStart, GivesTheTemperatureOfThePart) {
  FakeRpcServer server({{"job.start", FakeRpcServer::result({{"job_id", "J7"}, {"duplicate", false}})}});

  const Outcome outcome = fvd::test::run_command(
      {"--address", server.endpoint().text(), "start", "--seq", "8", "--part", "P1", "--temperature-c", "-3.25"});

  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(server.requests().at(0)["params"]["temperature_c"], -3.25);
}

TEST(FvdctlStart, RefusesATemperatureThatIsNone) {
  for (const char* text : {"nan", "inf", "-50.1", "100.5", "21C", "", "1e9"}) {
    const Outcome outcome = fvd::test::run_command({"start", "--part", "P1", "--temperature-c", text});
    EXPECT_EQ(outcome.code, kExitUsage) << text;
  }
}

}  // namespace
}  // namespace fvd::ctl
