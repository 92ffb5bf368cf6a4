/// A daemon keeps the lock of its drive while the drive is away.

#include <gtest/gtest.h>
#include <unistd.h>

#include "drivers/common/drive_lock.hpp"
#include "drivers/registry/driver_table.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

TEST(TheOpenerOfAnAxis, KeepsTheLockOfADriveThatIsAway) {
  DeviceConfigs devices;
  devices.stage.profile = FVD_SOURCE_DIR "/config/drives/oriental-az.json";
  devices.stage.address = "127.93.0.4";  // nothing listens there
  devices.stage.port = 1 + ::getpid() % 65535;
  auto openers = openers_of(devices);
  for (int i = 0; i < 2; ++i) {
    test::expect_error(ErrorCode::kStageDisconnected, {"127.93.0.4"}, [&] { (void)openers.axis(); });
    test::expect_error(ErrorCode::kStageTaken, {"process"}, [&] { const DriveLock other(devices.stage); });
  }
  openers = {};
  EXPECT_NO_THROW(const DriveLock other(devices.stage));
}

}  // namespace
}  // namespace fvd
