

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/ctl/exit_codes.hpp"
#include "tests/daemon/ctl/fake_rpc_server.hpp"
#include "tests/daemon/ctl/run_command.hpp"

namespace fvd::ctl {
namespace {

using nlohmann::json;
using test::FakeRpcServer;
using test::Outcome;
using test::run_command;
using testing::HasSubstr;

Outcome ask(const FakeRpcServer& server, std::vector<std::string> arguments, bool terminal = false) {
  arguments.insert(arguments.begin(), {"--address", server.endpoint().text()});
  return run_command(arguments, terminal);
}

json status(const char* state, int done, const char* phase = "acquiring") {
  return {{"job_id", "J7"},         {"seq", 8},
          {"state", state},         {"phase", phase},
          {"slices_done", done},    {"slices_planned", 4},
          {"progress", done / 4.0}, {"done", state != std::string("processing")}};
}

TEST(Fvdctl, PrintsTheState) {
  FakeRpcServer server({{"system.state", FakeRpcServer::result({{"state", "ready"}})}});
  const Outcome outcome = ask(server, {"state"});
  EXPECT_EQ(outcome.code, kExitOk);
  EXPECT_EQ(json::parse(outcome.out)["state"], "ready");
}

TEST(Fvdctl, StartsAJobWithTheSequenceNumberGiven) {
  FakeRpcServer server({{"job.start", FakeRpcServer::result({{"job_id", "J7"}, {"duplicate", false}})}});
  const Outcome outcome = ask(server, {"start", "--seq", "8", "--part", "P1", "--recipe", "chapter"});
  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(server.requests().at(0)["params"],
            json({{"seq", 8}, {"part_id", "P1"}, {"client", "fvdctl"}, {"recipe", "chapter"}}));
}

TEST(Fvdctl, TakesTheNextSequenceNumberByItself) {
  FakeRpcServer server({{"job.latest", FakeRpcServer::result({{"job_id", "J41"}, {"seq", 41}})},
                        {"job.start", FakeRpcServer::result({{"job_id", "J7"}})}});
  EXPECT_EQ(ask(server, {"start", "--part", "P1"}).code, kExitOk);
  EXPECT_EQ(server.requests().at(1)["params"], json({{"seq", 42}, {"part_id", "P1"}, {"client", "fvdctl"}}))
      << "no recipe: the prepared one";
}

TEST(Fvdctl, StartsAtOneWhereNoJobWasRun) {
  FakeRpcServer server({{"job.latest", FakeRpcServer::result({{"job_id", ""}, {"seq", 0}})},
                        {"job.start", FakeRpcServer::result({{"job_id", "J7"}})}});
  EXPECT_EQ(ask(server, {"start", "--part", "P1"}).code, kExitOk);
  EXPECT_EQ(server.requests().at(1)["params"]["seq"], 1);
}

TEST(Fvdctl, FollowsAJobToItsEnd) {
  FakeRpcServer server({{"job.wait", FakeRpcServer::result(status("processing", 1))},
                        {"job.wait", FakeRpcServer::result(status("processing", 1))},
                        {"job.wait", FakeRpcServer::result(status("processing", 3))},
                        {"job.wait", FakeRpcServer::result(status("completed", 4, ""))}});
  const Outcome outcome = ask(server, {"watch", "J7"});
  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(outcome.out, "acquiring  slice 1/4  25 %\nacquiring  slice 3/4  75 %\ncompleted  slice 4/4  100 %\n");
  EXPECT_EQ(server.requests().at(0)["params"]["job_id"], "J7");
  EXPECT_EQ(server.requests().at(0)["params"]["until"], "done");
}

TEST(Fvdctl, DrawsABarInATerminal) {
  FakeRpcServer server({{"job.wait", FakeRpcServer::result(status("processing", 2))},
                        {"job.wait", FakeRpcServer::result(status("completed", 4, ""))}});
  const Outcome outcome = ask(server, {"watch", "8"}, true);
  EXPECT_THAT(outcome.out, HasSubstr("\r[###############...............] acquiring  slice 2/4"));
  EXPECT_THAT(outcome.out, testing::EndsWith("\n"));
  EXPECT_EQ(server.requests().at(0)["params"]["seq"], 8);
}

TEST(Fvdctl, WatchesTheLatestJobWhenNoneIsNamed) {
  FakeRpcServer server({{"system.state", FakeRpcServer::result({{"job_id", "J9"}})},
                        {"job.wait", FakeRpcServer::result(status("completed", 4))}});
  EXPECT_EQ(ask(server, {"watch"}).code, kExitOk);
  EXPECT_EQ(server.requests().at(1)["params"]["job_id"], "J9");
}

TEST(Fvdctl, SaysThatThereIsNoJobYet) {
  FakeRpcServer server({{"system.state", FakeRpcServer::result({{"job_id", nullptr}})}});
  const Outcome outcome = ask(server, {"result"});
  EXPECT_EQ(outcome.code, kExitBadData);
  EXPECT_THAT(outcome.err, HasSubstr("no job yet"));
}

TEST(Fvdctl, ExitsWithOneWhenTheJobFailed) {
  json failed = status("failed", 2, "");
  failed["error"] = "camera_disconnected";
  failed["error_message"] = "no reply";
  FakeRpcServer server({{"job.wait", FakeRpcServer::result(failed)}});
  const Outcome outcome = ask(server, {"wait", "J7"});
  EXPECT_EQ(outcome.code, kExitJobFailed);
  EXPECT_EQ(outcome.err, "fvdctl: job J7 failed: camera_disconnected: no reply\n");
  EXPECT_EQ(json::parse(outcome.out)["state"], "failed");
}

TEST(Fvdctl, PrintsTheResultInTheFormatAskedFor) {
  FakeRpcServer server({{"result.get", FakeRpcServer::result({{"job_id", "J7"}, {"state", "completed"}})}});
  EXPECT_EQ(ask(server, {"result", "J7", "--format", "full"}).code, kExitOk);
  EXPECT_EQ(server.requests().at(0)["params"], json({{"job_id", "J7"}, {"format", "full"}}));
}

TEST(Fvdctl, ExitsWithOneForTheResultOfAJobThatFailed) {
  json failed = status("failed", 2, "");
  failed["error"] = "too_few_valid_points";
  failed["error_message"] = "only 12 % of the points are valid";
  FakeRpcServer server({{"result.get", FakeRpcServer::result({{"job_id", "J7"}, {"state", "failed"}})},
                        {"job.wait", FakeRpcServer::result(failed)}});
  const Outcome outcome = ask(server, {"result", "J7"});
  EXPECT_EQ(outcome.code, kExitJobFailed);
  EXPECT_EQ(json::parse(outcome.out)["state"], "failed");
  EXPECT_EQ(outcome.err, "fvdctl: job J7 failed: too_few_valid_points: only 12 % of the points are valid\n");
}

TEST(Fvdctl, ExitsWithUnavailableWhereThereIsNoResultYet) {
  FakeRpcServer server({{"result.get", FakeRpcServer::result({{"job_id", "J7"}, {"state", "processing"}})}});
  const Outcome outcome = ask(server, {"result", "J7"});
  EXPECT_EQ(outcome.code, kExitUnavailable);
  EXPECT_THAT(outcome.err, HasSubstr("no result yet"));
}

TEST(Fvdctl, CallsAnyMethod) {
  FakeRpcServer server({{"recipe.get", FakeRpcServer::result({{"id", "x"}})}});
  EXPECT_EQ(ask(server, {"rpc", "recipe.get", R"({"id":"x"})"}).code, kExitOk);
  EXPECT_EQ(server.requests().at(0)["params"]["id"], "x");
  EXPECT_EQ(run_command({"rpc", "a", "{"}).code, kExitBadData);
  EXPECT_EQ(run_command({"rpc", "a", "7"}).code, kExitBadData);
}

TEST(Fvdctl, TurnsErrorsOfTheDaemonIntoExitCodes) {
  for (const auto& [code, exit] : {std::pair{1005, kExitBadData},
                                   {1002, kExitUnavailable},
                                   {1132, kExitIo},
                                   {1101, kExitJobFailed},
                                   {-32602, kExitBadData},
                                   {-32603, kExitInternal}}) {
    FakeRpcServer server({{"job.start", FakeRpcServer::error({{"code", code}, {"message", "no such thing"}})}});
    const Outcome outcome = ask(server, {"start", "--seq", "1", "--part", "P"});
    EXPECT_EQ(outcome.code, exit) << code;
    EXPECT_THAT(outcome.err, HasSubstr("no such thing"));
  }
}

TEST(Fvdctl, ExitsWithUnavailableWithoutADaemon) {
  const Outcome outcome = run_command({"--runtime-dir", "/nonexistent", "state"});
  EXPECT_EQ(outcome.code, kExitUnavailable);
  EXPECT_THAT(outcome.err, HasSubstr("is fvd running?"));
}

TEST(Fvdctl, ExitsWithUsageForWrongArguments) {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"nonsense"},
      {"start"},
      {"start", "--part", "P", "--seq", "0"},
      {"start", "--part", "P", "--seq", "-1"},
      {"start", "--part", "P", "--seq", "99999999999999999999"},
      {"result", "--format", "long"},
      {"state", "--what"},
      {"--address", "a:1", "--runtime-dir", "/run/fvd", "state"},
      {"process", "folder"},
      {"process", "folder", "--out", "o", "--z-step-um", "0"},
      {"process", "folder", "--out", "o", "--z-step-um", "1", "--z-file", "z.txt"},
      {"process", "folder", "--out", "o", "--z-step-um", "1", "--peak", "mean"},
      {"process", "folder", "--out", "o", "--z-step-um", "1", "--z-unit", "mm"},
      {"process", "folder", "--out", "o", "--z-file", "z.txt", "--z-unit", "inch"},
  };
  for (const auto& arguments : wrong) {
    const Outcome outcome = run_command(arguments);
    EXPECT_EQ(outcome.code, kExitUsage) << testing::PrintToString(arguments);
    EXPECT_FALSE(outcome.err.empty());
  }
}

TEST(Fvdctl, SaysThatOptionsOfAllCommandsStandBeforeTheCommand) {
  const Outcome outcome = run_command({"wait", "4730", "--client", "plc"});
  EXPECT_EQ(outcome.code, kExitUsage);
  EXPECT_THAT(outcome.err, HasSubstr("not expected here: --client plc; --client stands before the command: fvdctl "
                                     "--client ... COMMAND"));
  EXPECT_THAT(run_command({"wait", "4730", "--bogus"}).err, HasSubstr("not expected here: --bogus\n"));
}

TEST(Fvdctl, NamesAnUnknownCommandAndTheNearest) {
  const Outcome near = run_command({"--runtime-dir", "/r", "stat"});
  EXPECT_EQ(near.code, kExitUsage);
  EXPECT_THAT(near.err, HasSubstr("'stat' is not a command; expected one of state, start, "));
  EXPECT_THAT(near.err, HasSubstr("did you mean 'state'?"));
  const Outcome far = run_command({"bogus"});
  EXPECT_EQ(far.code, kExitUsage);
  EXPECT_THAT(far.err, HasSubstr("'bogus' is not a command"));
}

TEST(Fvdctl, PrintsHelpAndVersion) {
  EXPECT_EQ(run_command({"--help"}).code, kExitOk);
  EXPECT_THAT(run_command({"--help"}).out, HasSubstr("process"));
  EXPECT_THAT(run_command({"--version"}).out, testing::StartsWith("fvdctl "));
}

}  // namespace
}  // namespace fvd::ctl
