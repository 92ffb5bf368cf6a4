/// fvd as a service manager starts it, without devices: recorded slices from an empty folder.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/store/job_store.hpp"
#include "tests/daemon/program/taken_port.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/service_manager.hpp"

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class AService : public test::AServiceManager {
 protected:
  void SetUp() override {
    AServiceManager::SetUp();
    std::filesystem::create_directories(folder_.path() / "recipes");
    std::filesystem::create_directories(folder_.path() / "slices");
  }
  void configure(const nlohmann::json& changes = {}) {
    nlohmann::json config{{"rpc", {{"port", 0}}},
                          {"camera", {{"driver", "replay"}, {"replay_dir", "slices"}}},
                          {"stage", {{"driver", "replay"}}},
                          {"log", {{"level", "info"}}},
                          {"paths",
                           {{"state_dir", (folder_.path() / "state").string()},
                            {"runtime_dir", (folder_.path() / "run").string()},
                            {"recipe_dir", "recipes"}}}};
    config.merge_patch(changes.is_null() ? nlohmann::json::object() : changes);
    test::write_text(folder_.path() / "fvd.json", config.dump());
  }
  void start() {
    program_ = std::make_unique<test::ChildProcess>(
        std::vector<std::string>{FVD_PROGRAM, "--config", (folder_.path() / "fvd.json").string()});
  }
  /// The next message to the service manager that begins so; "" after half a minute without one.
  std::string told(const std::string& begin) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < deadline) {
      if (std::string text = heard(); text.starts_with(begin)) return text;
    }
    return {};
  }
  int end() {
    program_->signal(SIGTERM);
    log_ = program_->rest();
    return program_->wait();
  }

  /// The loads of the configuration, the oldest first: "detail; outcome"; after end().
  std::vector<std::string> audited() {
    std::vector<std::string> rows;
    for (const AuditEntry& entry : JobStore(folder_.path() / "state" / "fvd.sqlite").audit().newest(100, 0)) {
      if (entry.what == "configuration.load") rows.insert(rows.begin(), entry.detail + "; " + entry.outcome);
    }
    return rows;
  }

  test::ScratchDir folder_;
  std::unique_ptr<test::ChildProcess> program_;
  std::string log_;  // after end()
};

TEST_F(AService, IsReadyAndEndsWhenToldTo) {
  configure();
  start();
  EXPECT_THAT(told("READY"), HasSubstr("\nSTATUS=listening on port "));
  EXPECT_EQ(end(), 0);
  EXPECT_NE(told("STOPPING=1"), "");
}

TEST_F(AService, WaitsForAPortThatAnotherProgramHas) {
  test::TakenPort taken;
  configure({{"rpc", {{"port", taken.port()}}}});
  start();
  EXPECT_THAT(told("STATUS=waiting: cannot listen on"), HasSubstr("another program"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "state")) << "nothing is opened before";
  taken.free();
  EXPECT_EQ(told("READY"), "READY=1\nSTATUS=listening on port " + std::to_string(taken.port()));
  EXPECT_EQ(end(), 0);
}

TEST_F(AService, EndsWhileItWaitsForAnAddress) {
  const nlohmann::json allow = nlohmann::json::array({{{"address", "192.0.2.9"}, {"role", "operate"}}});
  configure({{"rpc", {{"address", "192.0.2.1"}, {"port", 1}, {"allow", allow}}}});
  start();
  EXPECT_THAT(told("STATUS=waiting"), HasSubstr("no network card has this address yet"));
  EXPECT_EQ(end(), 0);
}

TEST_F(AService, TellsAPersonAtOnceThatThePortIsTaken) {
  const test::TakenPort taken;
  configure({{"rpc", {{"port", taken.port()}}}});
  ::unsetenv("NOTIFY_SOCKET");
  start();
  EXPECT_THAT(program_->rest(), HasSubstr("cannot listen on 127.0.0.1:" + std::to_string(taken.port())));
  EXPECT_EQ(program_->wait(), 69);
}

TEST_F(AService, TakesTheLogLevelWhileItRuns) {
  configure();
  start();
  const std::string ready = told("READY");
  configure({{"log", {{"level", "debug"}}}});
  program_->signal(SIGHUP);
  EXPECT_NE(told("RELOADING=1\n"), "");
  EXPECT_EQ(told("READY"), ready);
  EXPECT_EQ(end(), 0);
  EXPECT_THAT(log_, HasSubstr("reloaded /log/level: info -> debug"));
  EXPECT_THAT(audited(), ElementsAre(AllOf(HasSubstr("start of fvd"), HasSubstr("; ok")),
                                     AllOf(HasSubstr("/log/level: info -> debug; sha256"), HasSubstr("; ok"))));
}

TEST_F(AService, TakesNothingOfAConfigurationThatNeedsAStart) {
  configure();
  start();
  const std::string ready = told("READY");
  configure({{"log", {{"level", "error"}}}, {"compute", {{"threads", 1}}}});
  program_->signal(SIGHUP);
  EXPECT_NE(told("RELOADING=1\n"), "");
  EXPECT_EQ(told("READY"), ready + "; the last reload was refused, the log says why");
  configure();
  program_->signal(SIGHUP);
  EXPECT_NE(told("RELOADING=1\n"), "");
  EXPECT_EQ(told("READY"), ready);
  EXPECT_EQ(end(), 0);
  EXPECT_THAT(log_, HasSubstr("changed keys that only a restart takes: /compute/threads"));
  EXPECT_THAT(log_, HasSubstr("nothing differs")) << "at level info still";
  EXPECT_THAT(audited(), ElementsAre(HasSubstr("start of fvd"), HasSubstr("bad_config"), HasSubstr("nothing differs")));
}

TEST_F(AService, RefusesABrokenFileWith78) {
  test::write_text(folder_.path() / "fvd.json", "{");
  start();
  EXPECT_THAT(program_->rest(), HasSubstr("no valid JSON"));
  EXPECT_EQ(program_->wait(), 78);
}

}  // namespace
}  // namespace fvd
