/// The GCS port under the axis controller, opened by the table of drivers, against the simulated controller on real
/// lines.

#include <cmath>
#include <memory>
#include <thread>

#include "drivers/registry/driver_table.hpp"
#include "gtest/gtest.h"
#include "sim/gcs/gcs_server.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::expect_error;

sim::AxisParameters good_axis() {
  sim::AxisParameters parameters;
  parameters.settle_noise_um = 0.02;
  parameters.encoder_noise_um = 0.01;
  parameters.start_latency_ms = 3.0;
  return parameters;
}

enum class Line { kTcp, kSerial };
void PrintTo(Line line, std::ostream* out) { *out << (line == Line::kTcp ? "tcp" : "serial"); }

class GcsBench : public testing::Test {
 protected:
  explicit GcsBench(Line line = Line::kTcp) : server_(controller_, options_of(line)) {}

  static sim::GcsServerOptions options_of(Line line) {
    sim::GcsServerOptions options;
    if (line == Line::kSerial) options.terminal_link.emplace();
    return options;
  }

  [[nodiscard]] StageConfig config() const {
    StageConfig config;
    config.driver = "gcs";
    config.transport = server_.device().empty() ? "tcp" : "serial";
    config.port = server_.port();
    config.serial_device = server_.device();
    config.min = Micrometers{-500.0};
    config.max = Micrometers{1500.0};
    config.speed_um_per_s = 500.0;
    config.acceleration_um_per_s2 = 5000.0;
    return config;
  }
  [[nodiscard]] std::unique_ptr<Axis> open_homed() const {
    auto stage = open_stage(config());
    stage->home({});
    return stage;
  }
  [[nodiscard]] bool moves() { return axis_.moving(HostClock::now()); }
  void wait_until_it_moves() {
    while (!moves()) std::this_thread::yield();
  }

  SettleCriterion criterion_{
      .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(10), .timeout = milliseconds(5000)};
  sim::AxisModel axis_{good_axis()};
  sim::GcsController controller_{axis_};
  sim::GcsServer server_;
};

class AGcsStage : public GcsBench, public testing::WithParamInterface<Line> {
 protected:
  AGcsStage() : GcsBench(GetParam()) {}
};

TEST_P(AGcsStage, HomesAndStepsToSettledPositionsMeasuredTrue) {
  const auto stage = open_stage(config());
  EXPECT_FALSE(stage->status().homed);
  expect_error(ErrorCode::kStageNotHomed, {}, [&] { stage->move_to(Micrometers{1.0}, criterion_, {}); });
  stage->home({});
  EXPECT_TRUE(stage->status().homed);
  for (int i = 0; i < 5; ++i) {
    const MoveRecord move = stage->move_to(Micrometers{-7.0 + 10.0 * i}, criterion_, {});
    EXPECT_NEAR(move.position.value, -7.0 + 10.0 * i, 0.5);
    const HostTime now = HostClock::now();
    EXPECT_NEAR(stage->mean_position(now, now + milliseconds(6)).mean.value, axis_.true_position_um(now), 0.1);
  }
  EXPECT_EQ(controller_.moves(), 5);
  EXPECT_EQ(stage->link_stats()->unanswered, 0U);
}

INSTANTIATE_TEST_SUITE_P(On, AGcsStage, testing::Values(Line::kTcp, Line::kSerial),
                         [](const auto& on) { return on.param == Line::kTcp ? "Tcp" : "Serial"; });

using AGcsAxis = GcsBench;

TEST_F(AGcsAxis, RefusesTargetsOutsideItsLimitsAndLimitsBeyondTheControllers) {
  auto stage = open_homed();
  expect_error(ErrorCode::kStageLimit, {"1501", "nothing was moved"},
               [&] { stage->move_to(Micrometers{1501.0}, criterion_, {}); });
  EXPECT_EQ(controller_.moves(), 0);
  stage.reset();  // one at a time has the controller
  StageConfig wide = config();
  wide.max = Micrometers{2500.0};
  expect_error(ErrorCode::kStageLimit, {"-2000..2000"}, [&] { (void)open_stage(wide); });
}

TEST_F(AGcsAxis, SweepsAtTheSpeedThatIsAskedFor) {
  const auto stage = open_homed();
  const HostTime begun = HostClock::now();
  stage->sweep_to(Micrometers{100.0}, 200.0, {});
  EXPECT_GE(HostClock::now() - begun, milliseconds(480));
}

TEST_F(AGcsAxis, EndsAtRestWhenItsMoveRunsOutOfTime) {
  const auto stage = open_homed();
  criterion_.timeout = milliseconds(200);
  expect_error(ErrorCode::kStagePosition, {"did not settle"},
               [&] { stage->move_to(Micrometers{1400.0}, criterion_, {}); });
  EXPECT_FALSE(moves());
  criterion_.timeout = milliseconds(5000);
  EXPECT_NEAR(stage->move_to(Micrometers{50.0}, criterion_, {}).position.value, 50.0, 0.5)
      << "the stop's own error is not taken for one of the next move";
}

TEST_F(AGcsAxis, StopsFromAnotherThread) {
  const auto stage = open_homed();
  const std::jthread operator_thread([&] {
    wait_until_it_moves();
    stage->stop();
  });
  criterion_.timeout = milliseconds(1500);
  expect_error(ErrorCode::kStagePosition, {"did not settle"},
               [&] { stage->move_to(Micrometers{1400.0}, criterion_, {}); });
  EXPECT_LT(axis_.true_position_um(HostClock::now()), 300.0) << "not where the time ran out, at 700 um";
}

TEST_F(AGcsAxis, EndsAtRestOnAStopRequest) {
  const auto stage = open_homed();
  std::stop_source stop;
  const std::jthread operator_thread([&] {
    wait_until_it_moves();
    stop.request_stop();
  });
  expect_error(ErrorCode::kAborted, {}, [&] { stage->move_to(Micrometers{1400.0}, criterion_, stop.get_token()); });
  EXPECT_FALSE(moves());
}

TEST_F(AGcsAxis, ReportsAnAlarmInMotionAndKeepsIt) {
  const auto stage = open_homed();
  const std::jthread fault([&] {
    wait_until_it_moves();
    controller_.raise_alarm(-1024);
  });
  expect_error(ErrorCode::kStageAlarm, {"-1024", "servo switched off"},
               [&] { stage->move_to(Micrometers{1400.0}, criterion_, {}); });
  EXPECT_TRUE(stage->status().alarm) << "ERR? tells it once, the stage as long as it lasts";
  expect_error(ErrorCode::kStageAlarm, {"-1024"}, [&] { stage->move_to(Micrometers{10.0}, criterion_, {}); });
  stage->reset_alarm({});
  EXPECT_FALSE(stage->status().alarm);
}

TEST_F(AGcsAxis, SaysThatStandstillWasNotConfirmedOnALineThatFallsSilent) {
  const auto stage = open_homed();
  const std::jthread fault([&] {
    wait_until_it_moves();
    server_.set_mute(true);
  });
  const HostTime begun = HostClock::now();
  expect_error(ErrorCode::kStageDisconnected, {"standstill was not confirmed"},
               [&] { stage->move_to(Micrometers{1400.0}, criterion_, {}); });
  EXPECT_LT(HostClock::now() - begun, std::chrono::seconds(5));
  EXPECT_FALSE(stage->connected());
}

TEST_F(AGcsAxis, HaltsAnAxisThatMovesWhenItIsOpened) {
  open_homed().reset();
  (void)controller_.take("VEL 1 0.5\nMOV 1 1.9\n");
  wait_until_it_moves();
  const auto stage = open_stage(config());
  EXPECT_FALSE(moves());
  EXPECT_LT(axis_.true_position_um(HostClock::now()), 1800.0);
}

TEST_F(AGcsAxis, IsNotOpenedWhenItDoesNotStop) {
  open_homed().reset();
  (void)controller_.take("VEL 1 0.5\nMOV 1 1.9\n");
  wait_until_it_moves();
  controller_.refuse_stops(100);
  expect_error(ErrorCode::kStagePosition, {"found moving", "standstill was not confirmed"},
               [&] { (void)open_stage(config()); });
}

TEST_F(AGcsAxis, ReportsAMoveThatIsSilentlyIgnored) {
  const auto stage = open_homed();
  controller_.refuse_moves(1);
  expect_error(ErrorCode::kStagePosition, {"does not move"},
               [&] { stage->move_to(Micrometers{50.0}, criterion_, {}); });
}

TEST_F(AGcsAxis, DoesNotRepeatAMoveWhoseAnswerWasLost) {
  const auto stage = open_homed();
  server_.lose_answers(1);  // of a sample or of the move: neither may matter
  EXPECT_NEAR(stage->move_to(Micrometers{40.0}, criterion_, {}).position.value, 40.0, 0.5);
  EXPECT_EQ(controller_.moves(), 1);
}

TEST_F(AGcsAxis, IsNamedWhereTheControllerHasNoneOfThatName) {
  StageConfig other = config();
  other.gcs_axis = "Z";
  expect_error(ErrorCode::kStageDisconnected, {"no axis 'Z'", "gcs_axis"}, [&] { (void)open_stage(other); });
}

TEST(TheDriverTable, NamesTheDriversItHas) {
  StageConfig config;
  config.driver = "steam";
  expect_error(ErrorCode::kBadConfig, {"steam", "modbus, gcs, replay"}, [&] { (void)open_stage(config); });
}

TEST(TheDriverTable, ChecksWhatTheChosenDriverAsksFor) {
  StageConfig config;
  config.driver = "gcs";
  Problems problems;
  check_driver(config, problems);
  EXPECT_TRUE(problems.empty());
  config.transport = "rtu";
  config.gcs_axis = "a b";
  check_driver(config, problems);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].pointer, "/stage/transport");
  EXPECT_EQ(problems[1].pointer, "/stage/gcs_axis");
}

}  // namespace
}  // namespace fvd
