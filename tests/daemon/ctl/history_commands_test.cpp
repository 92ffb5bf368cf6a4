/// fvdctl jobs: what it asks for, part by part, and what it prints.

#include "daemon/ctl/history_commands.hpp"

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
using testing::HasSubstr;

Outcome jobs(const FakeRpcServer& server, std::vector<std::string> options) {
  options.insert(options.begin(), {"--address", server.endpoint().text(), "jobs"});
  return test::run_command(options);
}

json listed(int seq, const json& verdict = "pass") {
  return {{"job_id", "J" + std::to_string(seq)},
          {"seq", seq},
          {"client", "plc"},
          {"part_id", "P 1"},
          {"recipe", "groove"},
          {"state", "completed"},
          {"verdict", verdict},
          {"ended_utc", "2026-11-30T10:00:05.250Z"},
          {"error", ""}};
}

TEST(FvdctlJobs, PrintsALineForEach) {
  json running = listed(3, nullptr);
  running["state"] = "processing";
  running["ended_utc"] = "";
  json lost = listed(1, nullptr);
  lost["state"] = "failed";
  lost["error"] = "camera_frames_lost";
  FakeRpcServer server({{"job.list", FakeRpcServer::result({{"jobs", {running, listed(2), lost}}, {"next", ""}})}});

  const Outcome outcome = jobs(server, {});

  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(outcome.out,
            "-  processing  -  P 1  groove  J3\n"
            "2026-11-30T10:00:05.250Z  completed  pass  P 1  groove  J2\n"
            "2026-11-30T10:00:05.250Z  failed (camera_frames_lost)  -  P 1  groove  J1\n");
  EXPECT_EQ(server.requests().at(0)["params"], json({{"most", 50}}));
}

TEST(FvdctlJobs, AsksOnUntilThereAreEnough) {
  const auto part = [](int first, int count, const char* next) {
    json some = json::array();
    for (int i = 0; i < count; ++i) some.push_back(listed(first - i));
    return FakeRpcServer::result({{"jobs", some}, {"next", next}});
  };
  FakeRpcServer server({{"job.list", part(1000, 500, "x-500")}, {"job.list", part(500, 20, "x-480")}});

  const Outcome outcome = jobs(server, {"--most", "520", "--json", "--verdict", "none", "--part", "P"});

  EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).size(), 520U);
  EXPECT_EQ(server.requests().at(0)["params"], json({{"most", 500}, {"part_id", "P"}, {"verdict", "none"}}));
  EXPECT_EQ(server.requests().at(1)["params"],
            json({{"most", 20}, {"part_id", "P"}, {"verdict", "none"}, {"before", "x-500"}}));
}

TEST(FvdctlJobs, SaysThatThereAreNone) {
  FakeRpcServer server({{"job.list", FakeRpcServer::result({{"jobs", json::array()}, {"next", ""}})}});
  const Outcome outcome = jobs(server, {});
  EXPECT_EQ(outcome.code, kExitOk);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "no jobs\n");
}

TEST(FvdctlJobs, EndsWhereTheListEnds) {
  FakeRpcServer server({{"job.list", FakeRpcServer::result({{"jobs", json::array()}, {"next", ""}})}});
  const Outcome outcome = jobs(server, {"--from", "2026-11-30T10:00:00Z", "--to", "2026-11-30T11:00:00Z", "--recipe",
                                        "groove", "--state", "failed", "--text", "camera"});
  EXPECT_EQ(outcome.code, kExitOk);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("no such job"));
  EXPECT_EQ(server.requests().at(0)["params"], json({{"most", 50},
                                                     {"recipe", "groove"},
                                                     {"state", "failed"},
                                                     {"from_utc", "2026-11-30T10:00:00Z"},
                                                     {"to_utc", "2026-11-30T11:00:00Z"},
                                                     {"text", "camera"}}));
}

TEST(FvdctlJobs, RefusesWrongWordsBeforeItAsks) {
  for (const auto& wrong : std::vector<std::vector<std::string>>{
           {"--most", "0"}, {"--verdict", "ok"}, {"--state", "done"}, {"--before", "x"}, {"P1"}}) {
    std::vector<std::string> words{"--address", "127.0.0.1:1", "jobs"};
    words.insert(words.end(), wrong.begin(), wrong.end());
    EXPECT_EQ(test::run_command(words).code, kExitUsage) << wrong.front();
  }
}

}  // namespace
}  // namespace fvd::ctl
