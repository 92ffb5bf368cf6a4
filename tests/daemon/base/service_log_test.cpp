#include "daemon/base/service_log.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "core/runtime/guarded_thread.hpp"
#include "daemon/base/log_scope.hpp"

namespace fvd {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class AJournal : public ::testing::Test {
 protected:
  std::vector<std::string> entry_;  // the last one
  bool open_ = true;
  std::shared_ptr<spdlog::logger> log_ = journal_logger([this](const std::vector<std::string>& entry) {
    entry_ = entry;
    return open_;
  });
};

TEST_F(AJournal, GetsTextPriorityAndName) {
  log_->warn("the stage\nmoves");
  EXPECT_THAT(entry_, Contains("MESSAGE=the stage\nmoves"));
  EXPECT_THAT(entry_, Contains("PRIORITY=4"));
  EXPECT_THAT(entry_, Contains("SYSLOG_IDENTIFIER=fvd"));
  EXPECT_THAT(entry_, Not(Contains(StartsWith("FVD_"))));
  log_->critical("x");
  EXPECT_THAT(entry_, Contains("PRIORITY=2"));
  log_->error("x");
  EXPECT_THAT(entry_, Contains("PRIORITY=3"));
  log_->info("x");
  EXPECT_THAT(entry_, Contains("PRIORITY=6"));
}

TEST_F(AJournal, GetsJobPartAndCallerOfTheInnermostScope) {
  const LogScope call({.caller = "plc"});
  {
    const LogScope job({.job_id = "job-7", .part_id = "part 42"});
    log_->info("starts");
    EXPECT_THAT(entry_, Contains("FVD_JOB_ID=job-7"));
    EXPECT_THAT(entry_, Contains("FVD_PART_ID=part 42"));
    EXPECT_THAT(entry_, Contains("FVD_CALLER=plc"));
    const LogScope other({.caller = "fvdctl"});
    log_->info("goes on");
    EXPECT_THAT(entry_, Contains("FVD_CALLER=fvdctl"));
  }
  log_->info("ended");
  EXPECT_THAT(entry_, Not(Contains(StartsWith("FVD_JOB_ID"))));
  EXPECT_THAT(entry_, Contains("FVD_CALLER=plc"));
}

TEST_F(AJournal, KeepsTheScopesOfThreadsApart) {
  const LogScope job({.job_id = "job-7"});
  std::vector<std::string> elsewhere{"not run"};
  start_thread("fvd-test", [&](const std::stop_token&) { elsewhere = LogScope::fields(); }).join();
  EXPECT_TRUE(elsewhere.empty());
}

TEST_F(AJournal, ThatTakesNothingLosesNothing) {
  open_ = false;
  ::testing::internal::CaptureStderr();
  log_->error("full");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "<3>full\n");
}

TEST(ALogLevel, KeepsNothingFromWhatGetsWarningsBesideTheJournal) {
  const auto before = spdlog::default_logger();
  std::vector<std::string> journal;
  auto logger = journal_logger([&journal](const std::vector<std::string>& entry) {
    journal.push_back(entry.back());
    return true;
  });
  std::ostringstream beside;
  auto warnings = std::make_shared<spdlog::sinks::ostream_sink_st>(beside);
  warnings->set_pattern("%v");
  warnings->set_level(spdlog::level::warn);
  logger->sinks().push_back(warnings);
  spdlog::set_default_logger(logger);

  set_log_level(spdlog::level::err);
  spdlog::info("a");
  spdlog::warn("b");
  spdlog::error("c");
  set_log_level(spdlog::level::debug);
  spdlog::trace("d");
  spdlog::debug("e");
  spdlog::set_default_logger(before);

  EXPECT_EQ(journal, (std::vector<std::string>{"MESSAGE=c", "MESSAGE=e"}));
  EXPECT_EQ(beside.str(), "b\nc\n");
}

}  // namespace
}  // namespace fvd
