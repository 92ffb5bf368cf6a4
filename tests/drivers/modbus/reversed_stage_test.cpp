/// Stages that are built the other way round: z grows where the drive's own position falls.

#include <cmath>

#include "drivers/gcs/gcs_axis.hpp"
#include "gtest/gtest.h"
#include "sim/gcs/gcs_server.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

sim::AxisParameters built_the_other_way_round() {
  sim::AxisParameters axis = test::good_axis();
  axis.reversed = true;
  return axis;
}

/// Moves to z = 60 um and expects everything that tells of positions to agree with where the lens truly is.
void expect_z_to_be_true(Axis& stage, const sim::AxisModel& axis) {
  const MoveRecord move = stage.move_to(Micrometers{60.0}, {}, {});
  const HostTime now = HostClock::now();
  EXPECT_NEAR(axis.true_position_um(now), 60.0, 0.2);
  EXPECT_NEAR(move.position.value, 60.0, 0.2);
  EXPECT_NEAR(stage.status().position.value, 60.0, 0.2);
  EXPECT_NEAR(stage.mean_position(now, now + std::chrono::milliseconds(1)).mean.value, 60.0, 0.2);
  EXPECT_LT(axis.command_steps(HostClock::now()), 0) << "the drive went the other way";
}

class AReversedDrive : public testing::TestWithParam<test::DriveCase> {};

TEST_P(AReversedDrive, GoesWhereZSays) {
  test::SimulatedDrive plant(GetParam(), test::Transport::kTcp, built_the_other_way_round());
  StageConfig config = plant.config();
  config.reversed = true;
  const auto stage = open_modbus_stage(config);
  stage->home({});
  expect_z_to_be_true(*stage, plant.axis());
}

INSTANTIATE_TEST_SUITE_P(Of, AReversedDrive, testing::ValuesIn(test::kDriveCases),
                         [](const auto& on) { return testing::PrintToString(on.param); });

StageConfig reversed_controller(int port, Micrometers min) {
  StageConfig config;
  config.driver = "gcs";
  config.port = port;
  config.min = min;
  config.max = Micrometers{500.0};
  config.reversed = true;
  return config;
}

TEST(AReversedController, GoesWhereZSays) {
  sim::AxisModel axis(built_the_other_way_round());
  sim::GcsController controller(axis);
  sim::GcsServer server(controller, sim::GcsServerOptions{});
  const StageConfig config = reversed_controller(server.port(), Micrometers{-500.0});
  const auto stage = open_gcs_stage(config);
  stage->home({});
  expect_z_to_be_true(*stage, axis);
}

TEST(AReversedController, ChecksTheLimitsOfZAgainstItsOwnTurnedRound) {
  sim::AxisModel axis(test::good_axis());
  sim::GcsController controller(axis);
  sim::GcsServer server(controller, sim::GcsServerOptions{});
  const StageConfig config = reversed_controller(server.port(), Micrometers{-1e6});
  test::expect_error(ErrorCode::kStageLimit, {"narrow /stage/min_um"}, [&] { (void)open_gcs_stage(config); });
}

}  // namespace
}  // namespace fvd
