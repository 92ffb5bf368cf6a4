/// The watchdog of a drive that has one: it stops the axis if fvd falls silent, so it stays armed as long as fvd may
/// move the axis, and fvd is never silent for that long.

#include <array>
#include <future>

#include "gtest/gtest.h"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

constexpr int kTimeoutRegister = 0x1200;  // of the AR series, ms
constexpr test::DriveCase kArDrive{sim::DriveKind::kAr, "oriental-ar.json", "Ar"};

std::uint32_t timeout_ms(sim::SimDrive& drive) {
  std::array<std::uint16_t, 2> words{};
  EXPECT_EQ(drive.read(kTimeoutRegister, words), sim::ModbusException::kNone);
  return (std::uint32_t{words[0]} << 16U) | words[1];
}

TEST(ADrivesWatchdog, StaysArmedFromTheOpeningOverEveryMoveAndIsDisarmedAtTheEnd) {
  test::SimulatedDrive simulated(kArDrive, test::Transport::kTcp);
  ASSERT_EQ(timeout_ms(simulated.drive()), 0U);
  auto stage = simulated.open_homed();
  EXPECT_EQ(timeout_ms(simulated.drive()), 1000U);

  for (const double target_um : {0.0, 10.0, 20.0, 1000.0}) {
    const SettleCriterion criterion;
    auto move = std::async(std::launch::async, [&] { return stage->move_to(Micrometers{target_um}, criterion, {}); });
    while (move.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
      EXPECT_EQ(timeout_ms(simulated.drive()), 1000U) << "on the way to " << target_um << " um";
    }
    EXPECT_NO_THROW(move.get());
  }
  EXPECT_FALSE(stage->status().alarm) << "it was never silent for so long that the drive stopped by itself";

  stage.reset();
  EXPECT_EQ(timeout_ms(simulated.drive()), 0U);
}

TEST(ADrivesWatchdog, IsArmedAgainAfterTheDriveWasRestarted) {
  test::SimulatedDrive simulated(kArDrive, test::Transport::kTcp);
  const auto stage = simulated.open_homed();
  simulated.drive().power_cycle();
  ASSERT_EQ(timeout_ms(simulated.drive()), 0U);
  stage->home({});
  EXPECT_EQ(timeout_ms(simulated.drive()), 1000U);
}

}  // namespace
}  // namespace fvd
