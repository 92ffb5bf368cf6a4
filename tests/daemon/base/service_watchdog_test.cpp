#include "daemon/base/service_watchdog.hpp"

#include <cstdlib>
#include <sstream>

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "core/runtime/thread_ticks.hpp"
#include "tests/support/service_manager.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class AServiceWatchdog : public test::AServiceManager {
 protected:
  AServiceWatchdog() : logger_before_(spdlog::default_logger()) {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(log_)));
  }
  ~AServiceWatchdog() override { spdlog::set_default_logger(logger_before_); }

  /// What was logged since the last call.
  std::string logged() {
    std::string text = log_.str();
    log_.str("");
    return text;
  }

  HostTime now_{std::chrono::hours(1)};
  ServiceWatchdog watchdog_;

 private:
  std::ostringstream log_;
  std::shared_ptr<spdlog::logger> logger_before_;
};

TEST_F(AServiceWatchdog, GivesASignOfLifeWhileEveryThreadTicks) {
  ThreadTicks ticks("fvd-camera", milliseconds(500));
  for (int i = 0; i < 3; ++i, now_ += milliseconds(400)) {
    ticks.tick(now_);
    watchdog_.look(now_);
    EXPECT_EQ(heard(), "WATCHDOG=1");
  }
  EXPECT_EQ(logged(), "");
}

TEST_F(AServiceWatchdog, GivesNoSignOfLifeOnceAThreadStallsAndSaysWhich) {
  ThreadTicks good("fvd-rpc", milliseconds(5000));
  ThreadTicks ticks("fvd-camera", milliseconds(500));
  good.tick(now_);
  ticks.tick(now_);
  now_ += milliseconds(501);
  watchdog_.look(now_);
  EXPECT_TRUE(hears_nothing());
  const std::string log = logged();
  EXPECT_THAT(log, HasSubstr("fvd-camera has not ticked for 501 ms"));
  EXPECT_THAT(log, testing::Not(HasSubstr("fvd-rpc")));
  watchdog_.look(now_ + milliseconds(100));
  EXPECT_EQ(logged(), "") << "said once";
}

TEST_F(AServiceWatchdog, GivesSignsOfLifeAgainOnceTheThreadGetsOn) {
  ThreadTicks ticks("fvd-camera", milliseconds(500));
  ticks.tick(now_);
  now_ += milliseconds(600);
  watchdog_.look(now_);
  ASSERT_TRUE(hears_nothing());
  (void)logged();
  ticks.rest();
  watchdog_.look(now_);
  EXPECT_EQ(heard(), "WATCHDOG=1");
  EXPECT_THAT(logged(), HasSubstr("fvd-camera gets on again"));
}

TEST_F(AServiceWatchdog, EndsNoMeasurementForAThreadThatNobodyWaitsFor) {
  ThreadTicks reaper("fvd-reap-camera", milliseconds(500));
  ThreadTicks retention("fvd-retention", milliseconds(500));
  for (ThreadTicks* ticks : {&reaper, &retention}) ticks->tick(now_);
  now_ += milliseconds(501);
  watchdog_.look(now_);
  EXPECT_EQ(heard(), "WATCHDOG=1");
  const std::string log = logged();
  EXPECT_THAT(log, HasSubstr("fvd-reap-camera has not ticked for 501 ms"));
  EXPECT_THAT(log, HasSubstr("fvd-retention has not ticked for 501 ms"));
  EXPECT_THAT(log, testing::Not(HasSubstr("systemd is told no more")));
  ThreadTicks machine("fvd-machine", milliseconds(500));
  machine.tick(now_);
  watchdog_.look(now_ + milliseconds(501));
  EXPECT_TRUE(hears_nothing()) << "beside them others still count";
  EXPECT_THAT(logged(), HasSubstr("fvd-machine has not ticked"));
}

TEST_F(AServiceWatchdog, EndsNoMeasurementForALongListOrAFileThatIsFetched) {
  for (const char* name : {"fvd-http-work", "fvd-http-files", "fvd-rpc-lists", "fvd-maps"}) {
    ThreadTicks ticks(name, milliseconds(500));
    ticks.tick(now_);
    watchdog_.look(now_ + milliseconds(501));
    EXPECT_EQ(heard(), "WATCHDOG=1") << name;
    EXPECT_THAT(logged(), HasSubstr("no measurement waits for it")) << name;
  }
}

TEST_F(AServiceWatchdog, CountsThreadsThatAJobMayWaitFor) {
  for (const char* name : {"fvd-reap-stage", "fvd-follow", "fvd-rpc-work"}) {
    ThreadTicks ticks(name, milliseconds(500));
    ticks.tick(now_);
    watchdog_.look(now_ + milliseconds(501));
    EXPECT_TRUE(hears_nothing()) << name;
    EXPECT_THAT(logged(), HasSubstr("systemd is told no more")) << name;
  }
}

TEST_F(AServiceWatchdog, LooksThreeTimesInTheTimeThatSystemdAllows) {
  ::setenv("WATCHDOG_USEC", "30000000", 1);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  EXPECT_EQ(ServiceWatchdog::interval(), milliseconds(10000));
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("WATCHDOG_PID");
  EXPECT_EQ(ServiceWatchdog::interval(), milliseconds(1000));
}

}  // namespace
}  // namespace fvd
