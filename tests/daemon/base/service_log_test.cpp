#include "daemon/base/service_log.hpp"

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace fvd
