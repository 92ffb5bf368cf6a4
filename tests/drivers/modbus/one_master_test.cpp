/// One master per drive: who comes second writes nothing, and a master on another machine is noticed.

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

constexpr SettleCriterion kCriterion{
    .window = Micrometers{0.5}, .samples = 3, .dwell = milliseconds(10), .timeout = milliseconds(5000)};

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
  EXPECT_NEAR(stage->move_to(Micrometers{300.0}, kCriterion, {}).position.value, 300.0, 0.5);
}

TEST_P(OneMaster, NoticesAnotherOnesTarget) {
  const auto stage = plant_.open_homed();
  stage->move_to(Micrometers{10.0}, kCriterion, {});
  ASSERT_TRUE(plant_.write_target_as_another_master(4321));
  const int moves = plant_.drive().moves();
  expect_error(ErrorCode::kStageTaken, {"another master", "4321"},
               [&] { stage->move_to(Micrometers{20.0}, kCriterion, {}); });
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
               [&] { stage->move_to(Micrometers{1000.0}, kCriterion, {}); });
  EXPECT_FALSE(plant_.axis().moving(HostClock::now())) << "it is halted";
}

TEST_P(OneMaster, MistakesNothingOfItsOwnForAnothers) {
  const auto stage = plant_.open_homed();
  for (int i = 1; i <= 12; ++i) {
    EXPECT_NO_THROW(stage->move_to(Micrometers{10.0 * i}, kCriterion, {}));
    if (i % 4 == 0) stage->stop();
    if (i == 8) stage->home({});
  }
}

INSTANTIATE_TEST_SUITE_P(With, OneMaster, testing::ValuesIn(test::kDriveCases),
                         [](const auto& on) { return testing::PrintToString(on.param); });

}  // namespace
}  // namespace fvd
