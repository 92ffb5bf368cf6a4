#include "sim/drives/drive_kinds.hpp"

#include "gtest/gtest.h"
#include "tests/sim/modbus/modbus_requests.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd::sim {
namespace {

TEST(DriveKinds, AreMadeByTheirNames) {
  for (const auto& name : drive_names()) {
    AxisModel axis{AxisParameters{}};
    const auto drive = make_drive(drive_kind(name), axis);
    ASSERT_NE(drive, nullptr) << name;
    EXPECT_EQ(drive->moves(), 0);
    // Anything may be asked of it, and nothing of that may break it.
    for (int address = 0; address <= 0xFFFF; address += 7) {
      const ModbusBytes read = respond(*drive, test::short_request(3, address, 3));
      EXPECT_TRUE(read.size() == 8 || read.size() == 2) << name << ' ' << address;
      for (const int value : {1, 0xFFFF, 0x8000}) (void)respond(*drive, test::short_request(6, address, value));
    }
  }
}

TEST(DriveKinds, AreNotMadeByOtherNames) {
  fvd::test::expect_error(ErrorCode::kBadConfig, {"'azz'"}, [] { (void)drive_kind("azz"); });
}

}  // namespace
}  // namespace fvd::sim
