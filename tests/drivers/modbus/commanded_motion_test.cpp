/// What is sent to a drive and what is not: speeds, stops that came before, limit switches, alarms of several bits.

#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::expect_error;
using test::Transport;

class ACommandedMotion : public testing::TestWithParam<test::DriveCase> {
 protected:
  test::SimulatedDrive plant_{GetParam(), Transport::kTcp};
};

TEST_P(ACommandedMotion, OfASweepIsAsSlowAsAskedAndTheNextMoveAsFastAsBefore) {
  const auto stage = plant_.open_homed();
  stage->move_to(Micrometers{0}, test::kCriterion, {});
  const MoveRecord sweep = stage->sweep_to(Micrometers{60}, 120.0, {});
  EXPECT_GE(sweep.settled - sweep.started, milliseconds(450)) << "60 um at 120 um/s take half a second";
  const MoveRecord move = stage->move_to(Micrometers{0}, test::kCriterion, {});
  EXPECT_LT(move.halted - move.started, milliseconds(450)) << "at " << stage->info().speed_um_per_s << " um/s";
}

TEST_P(ACommandedMotion, DoesNotBeginOnceAStopIsRequested) {
  const auto stage = plant_.open_homed();
  const int moves = plant_.drive().moves();
  const double z_um = plant_.axis().true_position_um(HostClock::now());
  std::stop_source stop;
  stop.request_stop();
  expect_error(ErrorCode::kAborted, {}, [&] { stage->move_to(Micrometers{300}, test::kCriterion, stop.get_token()); });
  expect_error(ErrorCode::kAborted, {}, [&] { stage->sweep_to(Micrometers{300}, 200.0, stop.get_token()); });
  expect_error(ErrorCode::kAborted, {}, [&] { stage->home(stop.get_token()); });
  EXPECT_EQ(plant_.drive().moves(), moves);
  EXPECT_NEAR(plant_.axis().true_position_um(HostClock::now()), z_um, 1.0);
  EXPECT_TRUE(stage->status().enabled) << "nothing moved, so nothing was halted";
}

TEST_P(ACommandedMotion, ThatIsRefusedLeavesTheReference) {
  const auto stage = plant_.open_homed();
  stage->move_to(Micrometers{20}, test::kCriterion, {});
  plant_.faults().add({.on = sim::FaultOn::kWrite, .fault = sim::FaultKind::kException, .code = 4});
  expect_error(ErrorCode::kStagePosition, {"refused"}, [&] { stage->move_to(Micrometers{40}, test::kCriterion, {}); });
  EXPECT_NEAR(stage->move_to(Micrometers{60}, test::kCriterion, {}).position.value, 60.0, 1.0)
      << "no homing is asked for";
}

INSTANTIATE_TEST_SUITE_P(With, ACommandedMotion, testing::ValuesIn(test::kDriveCases),
                         [](const auto& on) { return testing::PrintToString(on.param); });

TEST(ADriveWithAlarmBits, LosesItsReferenceByOneOfSeveral) {
  test::SimulatedDrive plant{test::kDriveCases[3], Transport::kTcp};  // SCL
  const auto stage = plant.open_homed();
  plant.drive().raise_alarm(0x0201);
  expect_error(ErrorCode::kStageAlarm, {"0x201", "position error limit", "encoder error", "home again"},
               [&] { stage->move_to(Micrometers{10}, test::kCriterion, {}); });
  EXPECT_FALSE(stage->status().homed);
}

TEST(ADriveOnALimitSwitch, IsHomedAwayFromIt) {
  test::SimulatedDrive plant{test::kDriveCases[3], Transport::kTcp};  // SCL tells the switch, as an alarm
  const auto stage = plant.open_homed();
  plant.drive().limit_hit();
  expect_error(ErrorCode::kStageAlarm, {"limit"}, [&] { stage->move_to(Micrometers{10}, test::kCriterion, {}); });
  EXPECT_NO_THROW(stage->home({}));
  EXPECT_NEAR(plant.axis().true_position_um(HostClock::now()), 0.0, 5.0);
}

}  // namespace
}  // namespace fvd
