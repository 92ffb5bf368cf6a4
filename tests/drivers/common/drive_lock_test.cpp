/// One master per drive, on the whole machine, whatever became of the last one.

#include "drivers/common/drive_lock.hpp"

#include <csignal>
#include <filesystem>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::expect_error;

/// A drive that no other test has: nothing listens there, and nothing has to.
StageConfig drive(int unit = 1) {
  StageConfig config;
  config.address = "127.93.0.1";
  config.port = 1 + ::getpid() % 65535;
  config.unit = unit;
  return config;
}

TEST(ADriveLock, IsHeldByOneAndNamesHim) {
  const DriveLock lock(drive());
  expect_error(ErrorCode::kStageTaken, {"process " + std::to_string(::getpid()), "(driver_common_t"},
               [] { const DriveLock second(drive()); });
}

TEST(ADriveLock, IsFreeOnceItsHolderIsGone) {
  { const DriveLock lock(drive()); }
  EXPECT_FALSE(std::filesystem::exists(drive_lock_folder() / drive_lock_name(drive()))) << "it leaves nothing behind";
  EXPECT_NO_THROW(const DriveLock lock(drive()));
}

TEST(ADriveLock, LeavesOtherUnitsOfTheSameHostAlone) {
  const DriveLock lock(drive(1));
  EXPECT_NO_THROW(const DriveLock other(drive(2)));
}

TEST(ADriveLock, OfAProcessThatWasKilledIsFree) {
  int ready[2] = {-1, -1};
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t holder = ::fork();
  if (holder == 0) {
    StageConfig config = drive(3);
    config.port = 1 + ::getppid() % 65535;
    const DriveLock lock(config);
    [[maybe_unused]] const auto written = ::write(ready[1], "x", 1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  expect_error(ErrorCode::kStageTaken, {"process " + std::to_string(holder)}, [] { const DriveLock second(drive(3)); });
  ::kill(holder, SIGKILL);
  ::waitpid(holder, nullptr, 0);
  EXPECT_NO_THROW(const DriveLock lock(drive(3)));
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST(ADriveLock, IsTheSameByEveryNameOfTheDrive) {
  StageConfig one = drive();
  StageConfig other = drive();
  one.address = "127.0.0.1";
  other.address = "127.1";
  EXPECT_EQ(drive_lock_name(one), drive_lock_name(other));
  other.address = "localhost";
  EXPECT_EQ(drive_lock_name(one), drive_lock_name(other)) << "also where ::1 comes first";

  const test::ScratchDir folder;
  std::filesystem::create_symlink("/dev/null", folder.path() / "by-id");
  one.transport = other.transport = "rtu";
  one.serial_device = "/dev/null";
  other.serial_device = (folder.path() / "by-id").string();
  other.unit = 7;
  EXPECT_EQ(drive_lock_name(one), drive_lock_name(other)) << "a serial line has one master, whatever hangs on it";
}

TEST(ADriveLock, SaysThatAHostHasNoAddress) {
  StageConfig config = drive();
  config.address = "no such host";
  expect_error(ErrorCode::kStageDisconnected, {"no such host", "/stage/address"},
               [&] { const DriveLock lock(config); });
}

TEST(ADriveLock, NeverMistakesOneNameForAnother) {
  StageConfig one;
  StageConfig other;
  one.transport = other.transport = "rtu";
  one.serial_device = "/nowhere/a_b";
  other.serial_device = "/nowhere/a/b";
  EXPECT_NE(drive_lock_name(one), drive_lock_name(other));
}

}  // namespace
}  // namespace fvd
