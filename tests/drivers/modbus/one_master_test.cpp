/// One master per drive: who comes second writes nothing, and a master on another machine is noticed.

#include <array>
#include <atomic>
#include <functional>
#include <thread>

#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::expect_error;
using test::Transport;

/// Lets a drive be seen, and counts what is written to it.
class WriteCounter final : public sim::RegisterBank {
 public:
  explicit WriteCounter(sim::RegisterBank& drive) : drive_(drive) {}
  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    return drive_.read(address, values);
  }
  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    ++writes_;
    return drive_.write(address, values);
  }
  void idle() override { drive_.idle(); }
  [[nodiscard]] int writes() const noexcept { return writes_; }

 private:
  sim::RegisterBank& drive_;
  std::atomic<int> writes_{0};
};

class OneMaster : public testing::TestWithParam<test::DriveCase> {
 protected:
  [[nodiscard]] StageConfig counted() {
    StageConfig config = plant_.config();
    config.port = std::get<ModbusTcpEndpoint>(line_.config().endpoint).port;
    return config;
  }

  test::SimulatedDrive plant_{GetParam(), Transport::kTcp};
  WriteCounter counter_{plant_.drive()};
  sim::FaultScript no_faults_;
  test::SimulatedLine line_{Transport::kTcp, counter_, no_faults_};
};

TEST_P(OneMaster, WritesNothingToADriveThatRestsBeforeTheFirstMotion) {
  const auto stage = open_modbus_stage(counted());
  for (int i = 0; i < 5; ++i) (void)stage->status();
  EXPECT_EQ(counter_.writes(), 0) << "enabling waits until somebody wants to move";
  stage->home({});
  EXPECT_TRUE(stage->status().enabled);
}

TEST_P(OneMaster, LeavesASecondOneOutWhileTheAxisMoves) {
  StageConfig config = counted();
  config.speed_um_per_s = 400.0;
  const auto stage = open_modbus_stage(config);
  stage->home({});
  const std::jthread second([&] {
    // Far enough for all of a start's writes to have been sent.
    while (plant_.axis().true_position_um(HostClock::now()) < 80.0) std::this_thread::yield();
    const int before = counter_.writes();
    expect_error(ErrorCode::kStageTaken, {"in use by process"}, [&] { (void)open_modbus_stage(config); });
    EXPECT_EQ(counter_.writes(), before);
  });
  EXPECT_NEAR(stage->move_to(Micrometers{300.0}, test::kCriterion, {}).position.value, 300.0, 0.5);
}

TEST_P(OneMaster, EndsNoAlarmOfADriveThatAnotherOneHas) {
  const auto stage = open_modbus_stage(counted());
  stage->home({});
  stage->move_to(Micrometers{10.0}, test::kCriterion, {});
  ASSERT_TRUE(plant_.write_target_as_another_master(4321));
  plant_.drive().raise_alarm(1);
  const int before = counter_.writes();
  expect_error(ErrorCode::kStageTaken, {"another master"}, [&] { stage->reset_alarm({}); });
  EXPECT_EQ(counter_.writes(), before) << "it may be waiting for that";
}

TEST_P(OneMaster, NoticesAnotherOnesTarget) {
  const auto stage = plant_.open_homed();
  stage->move_to(Micrometers{10.0}, test::kCriterion, {});
  ASSERT_TRUE(plant_.write_target_as_another_master(4321));
  const int moves = plant_.drive().moves();
  expect_error(ErrorCode::kStageTaken, {"another master", "4321"},
               [&] { stage->move_to(Micrometers{20.0}, test::kCriterion, {}); });
  EXPECT_EQ(plant_.drive().moves(), moves) << "who moves the axis is not for fvd to say any more";
  EXPECT_FALSE(plant_.axis().moving(HostClock::now()));
}

TEST_P(OneMaster, NoticesAnotherOneWhileItMoves) {
  StageConfig config = plant_.config();
  config.speed_um_per_s = 200.0;
  const auto stage = open_modbus_stage(config);
  stage->home({});
  const std::jthread other([&] {
    while (!plant_.axis().moving(HostClock::now())) std::this_thread::yield();
    EXPECT_TRUE(plant_.write_target_as_another_master(77));
  });
  expect_error(ErrorCode::kStageTaken, {"another master", "77"},
               [&] { stage->move_to(Micrometers{1000.0}, test::kCriterion, {}); });
  EXPECT_FALSE(plant_.axis().moving(HostClock::now())) << "it is halted";
}

TEST_P(OneMaster, MistakesNothingOfItsOwnForAnothers) {
  const auto stage = plant_.open_homed();
  for (int i = 1; i <= 12; ++i) {
    EXPECT_NO_THROW(stage->move_to(Micrometers{10.0 * i}, test::kCriterion, {}));
    if (i % 4 == 0) stage->stop();
    if (i == 8) stage->home({});
  }
}

TEST_P(OneMaster, FindsADriveThatWasRestartedNotHomedAndHomesIt) {
  const auto stage = plant_.open_homed();
  stage->move_to(Micrometers{10.0}, test::kCriterion, {});
  plant_.drive().power_cycle();
  expect_error(ErrorCode::kStageNotHomed, {}, [&] { stage->move_to(Micrometers{20.0}, test::kCriterion, {}); });
  EXPECT_NO_THROW(stage->home({})) << "no other master has to go away first";
  EXPECT_NEAR(stage->move_to(Micrometers{20.0}, test::kCriterion, {}).position.value, 20.0, 0.5);
}

INSTANTIATE_TEST_SUITE_P(With, OneMaster, testing::ValuesIn(test::kDriveCases),
                         [](const auto& on) { return testing::PrintToString(on.param); });

constexpr test::DriveCase kAz = test::kDriveCases[0];
constexpr test::DriveCase kScl = test::kDriveCases[3];
constexpr int kSclOpcode = 124;

void write_word(test::SimulatedDrive& plant, int address, std::uint16_t word) {
  const std::array words{word};
  EXPECT_EQ(plant.drive().write(address, words), sim::ModbusException::kNone);
}

TEST(AnotherMaster, ThatDisablesTheDriveIsNotOverridden) {
  test::SimulatedDrive plant(test::kCia402, Transport::kTcp);
  const auto stage = plant.open_homed();
  stage->move_to(Micrometers{10.0}, test::kCriterion, {});
  write_word(plant, test::kCia402Controlword, 0);
  expect_error(ErrorCode::kStageTaken, {"controlword"},
               [&] { stage->move_to(Micrometers{20.0}, test::kCriterion, {}); });
  expect_error(ErrorCode::kStageTaken, {"controlword"}, [&] { stage->home({}); });
  EXPECT_FALSE(stage->status().enabled);
}

TEST(AnotherMaster, ThatSendsAHomedAxisToZeroIsNoRestart) {
  test::SimulatedDrive plant(kAz, Transport::kTcp);
  const auto stage = plant.open_homed();
  stage->move_to(Micrometers{10.0}, test::kCriterion, {});
  ASSERT_TRUE(plant.write_target_as_another_master(0));
  expect_error(ErrorCode::kStageTaken, {"another master"},
               [&] { stage->move_to(Micrometers{20.0}, test::kCriterion, {}); });
}

/// What another master does while the axis is on a long way.
void expect_taken_in_motion(const test::DriveCase& drive, const std::function<void(test::SimulatedDrive&)>& other) {
  test::SimulatedDrive plant(drive, Transport::kTcp);
  StageConfig config = plant.config();
  config.speed_um_per_s = 200.0;
  const auto stage = open_modbus_stage(config);
  stage->home({});
  const std::jthread thread([&] {
    while (plant.axis().true_position_um(HostClock::now()) < 10.0) std::this_thread::yield();
    other(plant);
  });
  expect_error(ErrorCode::kStageTaken, {"another master"},
               [&] { stage->move_to(Micrometers{1000.0}, test::kCriterion, {}); });
  EXPECT_FALSE(plant.axis().moving(HostClock::now()));
}

TEST(AnotherMaster, ThatDisablesAMovingAxisIsToldOfInPlaceOfAnAlarm) {
  expect_taken_in_motion(test::kCia402,
                         [](test::SimulatedDrive& plant) { write_word(plant, test::kCia402Controlword, 0); });
}

TEST(AnotherMaster, ThatStartsAMoveIsToldOfInPlaceOfALostReference) {
  expect_taken_in_motion(kScl, [](test::SimulatedDrive& plant) {
    write_word(plant, kSclOpcode, 0xE1);
    while (plant.axis().moving(HostClock::now())) std::this_thread::yield();
    EXPECT_TRUE(plant.write_target_as_another_master(77));
    write_word(plant, kSclOpcode, 0x67);
  });
}

}  // namespace
}  // namespace fvd
