#include "daemon/base/systemd_notify.hpp"

#include <cstdlib>

#include <gmock/gmock.h>

#include "tests/support/service_manager.hpp"

namespace fvd {
namespace {

using test::AServiceManager;

TEST_F(AServiceManager, HearsThatTheServiceIsReady) {
  notify_ready("listening on 127.0.0.1:7411");
  EXPECT_EQ(heard(), "READY=1\nSTATUS=listening on 127.0.0.1:7411");
}

TEST_F(AServiceManager, HearsTheStatusOnOneLine) {
  notify_status("job failed:\nWATCHDOG=trigger");
  EXPECT_EQ(heard(), "STATUS=job failed: WATCHDOG=trigger") << "a message must not become an assignment";
}

TEST_F(AServiceManager, HearsThatTheServiceReadsItsConfigurationAgain) {
  notify_reloading();
  EXPECT_THAT(heard(), ::testing::MatchesRegex("RELOADING=1\nMONOTONIC_USEC=[1-9][0-9]*"));
}

TEST_F(AServiceManager, HearsThatTheServiceStops) {
  notify_stopping();
  EXPECT_THAT(heard(), ::testing::StartsWith("STOPPING=1\n"));
}

TEST_F(AServiceManager, HearsNothingOfAServiceThatItDidNotStart) {
  notify_status("started");
  ASSERT_EQ(heard(), "STATUS=started") << "the socket hears";
  ::unsetenv("NOTIFY_SOCKET");
  notify_ready("x");
  notify_status("x");
  notify_stopping();
  EXPECT_TRUE(hears_nothing());
}

}  // namespace
}  // namespace fvd
