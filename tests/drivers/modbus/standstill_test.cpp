/// Every way out of a motion ends at a standstill that was measured, or in an error that says that it was not.

#include <atomic>
#include <thread>

#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::expect_error;
using test::Transport;

constexpr int kAzStopRegister = 0x0079;
constexpr double kSpeed_um_per_s = 500.0;

class AMotion : public testing::Test {
 protected:
  /// It speeds up and brakes for half a second.
  [[nodiscard]] std::unique_ptr<Axis> open_slow() const {
    StageConfig config = plant_.config();
    config.speed_um_per_s = kSpeed_um_per_s;
    config.acceleration_um_per_s2 = 1000.0;
    auto stage = open_modbus_stage(config);
    stage->home({});
    return stage;
  }
  [[nodiscard]] bool moves() { return plant_.axis().moving(HostClock::now()); }
  void wait_until_it_moves() {
    while (!moves()) std::this_thread::yield();
  }

  SettleCriterion criterion_{
      .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(10), .timeout = milliseconds(5000)};
  test::SimulatedDrive plant_{test::kDriveCases[0], Transport::kTcp};
};

TEST_F(AMotion, ThatRunsOutOfTimeEndsAtRest) {
  const auto stage = open_slow();
  criterion_.timeout = milliseconds(300);
  expect_error(ErrorCode::kStagePosition, {"did not settle"},
               [&] { stage->move_to(Micrometers{1000}, criterion_, {}); });
  EXPECT_FALSE(moves());
}

TEST_F(AMotion, ThatIsAbortedEndsAtRest) {
  const auto stage = open_slow();
  std::stop_source stop;
  const std::jthread operator_thread([&] {
    wait_until_it_moves();
    stop.request_stop();
  });
  expect_error(ErrorCode::kAborted, {}, [&] { stage->move_to(Micrometers{1000}, criterion_, stop.get_token()); });
  EXPECT_FALSE(moves());
}

TEST_F(AMotion, OfASweepThatIsAbortedEndsAtRest) {
  const auto stage = open_slow();
  std::stop_source stop;
  const std::jthread operator_thread([&] {
    wait_until_it_moves();
    stop.request_stop();
  });
  expect_error(ErrorCode::kAborted, {}, [&] { stage->sweep_to(Micrometers{1000}, 400.0, stop.get_token()); });
  EXPECT_FALSE(moves());
}

TEST_F(AMotion, OfAHomingThatIsAbortedEndsAtRest) {
  const auto stage = open_slow();
  stage->move_to(Micrometers{400}, criterion_, {});
  std::stop_source stop;
  const std::jthread operator_thread([&] {
    wait_until_it_moves();
    stop.request_stop();
  });
  expect_error(ErrorCode::kAborted, {}, [&] { stage->home(stop.get_token()); });
  EXPECT_FALSE(moves());
  EXPECT_GT(plant_.axis().true_position_um(HostClock::now()), 5.0) << "it was stopped on its way, not at its end";
}

TEST_F(AMotion, OnALineThatFallsSilentSaysThatStandstillWasNotConfirmed) {
  const auto stage = open_slow();
  const std::jthread fault([&] {
    wait_until_it_moves();
    plant_.line().set_mute(true);
  });
  expect_error(ErrorCode::kStageDisconnected, {"standstill was not confirmed"},
               [&] { stage->move_to(Micrometers{1400}, criterion_, {}); });
}

TEST_F(AMotion, WhoseStopsAreAllRefusedSaysThatStandstillWasNotConfirmed) {
  auto stage = open_slow();
  plant_.faults().add({.on = sim::FaultOn::kWrite,
                       .address = kAzStopRegister,
                       .count = 3,
                       .fault = sim::FaultKind::kException,
                       .code = 4});
  criterion_.timeout = milliseconds(100);
  expect_error(ErrorCode::kStagePosition, {"did not settle", "standstill was not confirmed"},
               [&] { stage->move_to(Micrometers{1450}, criterion_, {}); });
  EXPECT_EQ(plant_.faults().unconsumed(), 0U) << "the stop is sent three times";
  ASSERT_TRUE(moves());
  stage.reset();
  EXPECT_FALSE(moves()) << "an axis is not left moving by who closes it";
}

TEST_F(AMotion, ThatEndsByItselfAlthoughItsStopsAreRefusedIsMeasuredToRest) {
  const auto stage = open_slow();
  plant_.faults().add({.on = sim::FaultOn::kWrite,
                       .address = kAzStopRegister,
                       .count = 3,
                       .fault = sim::FaultKind::kException,
                       .code = 4});
  criterion_.timeout = milliseconds(50);
  std::string message;
  try {
    stage->move_to(Micrometers{100}, criterion_, {});
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_FALSE(moves());
  EXPECT_NE(message.find("did not settle"), std::string::npos);
  EXPECT_EQ(message.find("not confirmed"), std::string::npos) << message;
}

class AnOpening : public testing::TestWithParam<test::DriveCase> {
 protected:
  /// Something has set the axis in motion, at 500 um/s for four seconds, and nobody drives it any more.
  void leave_moving() {
    plant_.open_homed().reset();
    const double steps_per_um = plant_.axis().parameters().steps_per_um;
    const auto target = static_cast<std::int32_t>(2000.0 * steps_per_um);
    plant_.axis().move_to(HostClock::now(), target, kSpeed_um_per_s * steps_per_um, 20000.0 * steps_per_um,
                          20000.0 * steps_per_um);
    while (!plant_.axis().moving(HostClock::now())) std::this_thread::yield();
  }

  test::SimulatedDrive plant_{GetParam(), Transport::kTcp};
};

TEST_P(AnOpening, OfAnAxisThatMovesStopsItAndMeasuresRest) {
  leave_moving();
  const auto stage = plant_.open();
  EXPECT_FALSE(plant_.axis().moving(HostClock::now()));
  EXPECT_LT(plant_.axis().true_position_um(HostClock::now()), 1500.0);
  EXPECT_FALSE(stage->status().moving);
}

TEST_P(AnOpening, OfAnAxisThatDoesNotStopIsRefused) {
  leave_moving();
  plant_.faults().add({.on = sim::FaultOn::kWrite, .count = 1000, .fault = sim::FaultKind::kException, .code = 4});
  expect_error(ErrorCode::kStagePosition, {"found moving", "standstill was not confirmed"},
               [&] { (void)plant_.open(); });
}

INSTANTIATE_TEST_SUITE_P(With, AnOpening, testing::ValuesIn(test::kDriveCases),
                         [](const auto& on) { return testing::PrintToString(on.param); });

/// Lets a drive be seen, and remembers whether a control word took its torque away.
class ControlWordLog final : public sim::RegisterBank {
 public:
  explicit ControlWordLog(sim::RegisterBank& drive) : drive_(drive) {}
  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    return drive_.read(address, values);
  }
  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    constexpr int kControlWord = 6000;
    if (address == kControlWord && (values[0] & 0x0FU) != 0x0FU) took_torque_ = true;
    return drive_.write(address, values);
  }
  [[nodiscard]] bool took_torque() const { return took_torque_; }

 private:
  sim::RegisterBank& drive_;
  std::atomic<bool> took_torque_{false};
};

TEST(ADriveThatIsEnabledAndRests, StaysEnabledWhenItIsOpened) {
  test::SimulatedDrive plant(test::kDriveCases[4], Transport::kTcp);
  plant.open_homed().reset();
  ControlWordLog log(plant.drive());
  sim::FaultScript no_faults;
  const test::SimulatedLine line(Transport::kTcp, log, no_faults);
  StageConfig config = plant.config();
  config.port = std::get<ModbusTcpEndpoint>(line.config().endpoint).port;
  const auto stage = open_modbus_stage(config);
  EXPECT_TRUE(stage->status().enabled);
  EXPECT_FALSE(log.took_torque()) << "an axis without torque may sag";
}

TEST(ADriveThatSomebodyElseDisabled, IsNotEnabledAgainBeforeItIsHomed) {
  test::SimulatedDrive plant(test::kDriveCases[4], Transport::kTcp);
  const auto stage = plant.open_homed();
  const SettleCriterion criterion;
  stage->move_to(Micrometers{10}, criterion, {});
  plant.drive().emergency_stop();
  StageStatus seen = stage->status();
  EXPECT_TRUE(seen.lost_torque);
  EXPECT_FALSE(seen.homed);
  const int moves = plant.drive().moves();
  expect_error(ErrorCode::kStageAlarm, {"home again"}, [&] { stage->move_to(Micrometers{20}, criterion, {}); });
  stage->stop();
  expect_error(ErrorCode::kStageAlarm, {"home again"}, [&] { stage->move_to(Micrometers{20}, criterion, {}); });
  EXPECT_EQ(plant.drive().moves(), moves);
  stage->home({});
  seen = stage->status();
  EXPECT_FALSE(seen.lost_torque);
  EXPECT_TRUE(seen.homed);
  EXPECT_NEAR(stage->move_to(Micrometers{20}, criterion, {}).position.value, 20.0, 0.5);
}

class AnAlarmThatWasEnded : public testing::TestWithParam<test::DriveCase> {};

TEST_P(AnAlarmThatWasEnded, LeavesAnAxisHomedOnlyIfItMovesThen) {
  constexpr int kAlarm = 1;
  test::SimulatedDrive plant(GetParam(), Transport::kTcp);
  const auto stage = plant.open_homed();
  plant.drive().raise_alarm(kAlarm);
  EXPECT_TRUE(stage->status().alarm);
  stage->reset_alarm({});
  const StageStatus ended = stage->status();
  EXPECT_FALSE(ended.alarm) << ended.alarm_text;
  if (!ended.homed) stage->home({});
  EXPECT_NEAR(stage->move_to(Micrometers{20}, {}, {}).position.value, 20.0, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Of, AnAlarmThatWasEnded, testing::ValuesIn(test::kDriveCases),
                         [](const auto& on) { return testing::PrintToString(on.param); });

}  // namespace
}  // namespace fvd
