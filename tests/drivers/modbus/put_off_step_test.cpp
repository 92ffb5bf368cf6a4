/// A step of a sequence that was put off or not answered: it is gone back to, nothing before it is sent again, and who
/// no longer wants the motion need not wait for it.

#include <array>
#include <atomic>
#include <future>
#include <map>
#include <thread>

#include "drivers/modbus/drive_sequence.hpp"
#include "drivers/modbus/modbus_link.hpp"
#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"
#include "tests/support/gated_bank.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::expect_error;
using test::Transport;

constexpr test::DriveCase kAr = test::kDriveCases[1];
constexpr int kArInput = 0x007C;
constexpr int kArSpeed = 0x0480;

StageConfig behind(const test::SimulatedDrive& plant, const test::SimulatedLine& line) {
  StageConfig config = plant.config();
  config.port = std::get<ModbusTcpEndpoint>(line.config().endpoint).port;
  return config;
}

/// No answer, and then none to its repetitions either.
sim::FaultStep lost(int address) {
  return {.on = sim::FaultOn::kWrite, .address = address, .count = 3, .fault = sim::FaultKind::kLostRequest};
}

class ADriveWithAnOldTarget : public testing::TestWithParam<test::DriveCase> {};

TEST_P(ADriveWithAnOldTarget, NeverStartsTowardsIt) {
  test::SimulatedDrive plant(GetParam(), Transport::kTcp);
  StageConfig config = plant.config();
  config.speed_um_per_s = 400.0;
  const auto stage = open_modbus_stage(config);
  stage->home({});
  std::stop_source stop;
  const std::jthread user([&] {
    while (plant.axis().true_position_um(HostClock::now()) < 50.0) std::this_thread::yield();
    stop.request_stop();
  });
  expect_error(ErrorCode::kAborted, {},
               [&] { stage->move_to(Micrometers{1200.0}, test::kCriterion, stop.get_token()); });

  // So near that the axis stands within the window already: where it stands tells nothing.
  const double target_um = stage->status().position.value + 0.3;
  plant.faults().add(lost(test::target_address(GetParam().kind)));
  EXPECT_NO_THROW(stage->move_to(Micrometers{target_um}, test::kCriterion, {}));
  EXPECT_NEAR(plant.axis().true_position_um(HostClock::now()), target_um, 0.25);
  EXPECT_FALSE(plant.axis().moving(HostClock::now()));
  EXPECT_EQ(plant.faults().unconsumed(), 0U);
}

INSTANTIATE_TEST_SUITE_P(With, ADriveWithAnOldTarget, testing::Values(kAr, test::kDriveCases[3], test::kCia402),
                         [](const auto& on) { return testing::PrintToString(on.param); });

TEST(ADriveWithAnOldSpeed, DoesNotStartAtIt) {
  test::SimulatedDrive plant(kAr, Transport::kTcp);
  const auto stage = plant.open_homed();
  stage->move_to(Micrometers{10.0}, test::kCriterion, {});
  const int before = plant.drive().moves();
  plant.faults().add(lost(kArSpeed));
  EXPECT_NO_THROW(stage->sweep_to(Micrometers{12.0}, 20.0, {}));
  std::array<std::uint16_t, 2> words{};
  ASSERT_EQ(plant.drive().read(kArSpeed, words), sim::ModbusException::kNone);
  EXPECT_EQ(words[1], 2000);
  EXPECT_EQ(plant.drive().moves(), before + 1);
}

TEST(AHoming, ThatEndedIsNotRunAgainForItsLastStep) {
  test::SimulatedDrive plant(test::kCia402, Transport::kTcp);
  std::atomic<int> starts{0};
  std::atomic<int> put_off{0};
  test::GatedBank bank(plant.drive(), [&](int address, std::span<const std::uint16_t> values) {
    if (address != test::kCia402Controlword) return sim::ModbusException::kNone;
    if (values.front() == 0x001F) ++starts;
    const bool is_last = starts > 0 && values.size() == 2 && values[0] == 0x000F && values[1] == 1;
    if (!is_last || put_off == 20) return sim::ModbusException::kNone;  // for longer than the link's patience
    ++put_off;
    return test::kBusy;
  });
  sim::FaultScript no_faults;
  const test::SimulatedLine line(Transport::kTcp, bank, no_faults);
  const auto stage = open_modbus_stage(behind(plant, line));
  stage->home({});
  EXPECT_EQ(starts, 1);
  EXPECT_EQ(put_off, 20);
  EXPECT_NEAR(stage->move_to(Micrometers{10.0}, test::kCriterion, {}).position.value, 10.0, 0.5);
}

TEST(AHoming, ThatBeganWithoutAnAnswerIsCompleted) {
  test::SimulatedDrive plant(kAr, Transport::kTcp);
  std::atomic<int> starts{0};
  test::GatedBank bank(plant.drive(), [&](int address, std::span<const std::uint16_t> values) {
    if (address != kArInput || values.back() != 0x0010) return sim::ModbusException::kNone;
    ++starts;
    (void)plant.drive().write(address, values);
    return test::kAcknowledge;
  });
  sim::FaultScript no_faults;
  const test::SimulatedLine line(Transport::kTcp, bank, no_faults);
  const auto stage = open_modbus_stage(behind(plant, line));
  stage->home({});
  EXPECT_EQ(starts, 1);
  std::array<std::uint16_t, 2> input{};
  ASSERT_EQ(plant.drive().read(kArInput, input), sim::ModbusException::kNone);
  EXPECT_EQ(input[1], 0) << "an edge that stays set makes the next homing none";
}

/// Four registers, and what is done with them.
class Registers final : public sim::RegisterBank {
 public:
  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    for (auto& value : values) value = words_.at(static_cast<std::size_t>(address++)).load();
    return sim::ModbusException::kNone;
  }
  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    for (const auto value : values) words_.at(static_cast<std::size_t>(address++)) = value;
    return sim::ModbusException::kNone;
  }
  void idle() override {}
  std::array<std::atomic<std::uint16_t>, 4> words_{};
};

DriveRegister word_at(int address) {
  DriveRegister reg;
  reg.name = "word";
  reg.address = address;
  reg.type = RegisterType::kU16;
  return reg;
}

DriveCondition is_set(const DriveRegister& reg) { return DriveCondition::compare(reg, 1, 1, true); }

class ABusyDrive : public testing::Test {
 protected:
  /// Runs the step until it was put off three times, and then asks it to stop.
  SequenceResult stopped(ModbusLink& link, const DriveStep& step) {
    std::stop_source stop;
    const DriveSequence sequence{step};
    const auto before = link.stats().later;
    auto running = std::async(std::launch::async, [&] {
      return run_sequence(link, sequence, {}, ModbusPriority::kNormal, stop.get_token());
    });
    while (link.stats().later < before + 3) std::this_thread::yield();
    stop.request_stop();
    EXPECT_EQ(running.wait_for(std::chrono::seconds(10)), std::future_status::ready);
    return running.get();
  }
  [[nodiscard]] ModbusLinkConfig patient() const {
    ModbusLinkConfig config = line_.config();
    config.patience = std::chrono::seconds(20);
    return config;
  }

  Registers registers_;
  std::atomic<bool> puts_off_reads_{false};
  std::atomic<bool> puts_off_bit_{false};
  std::atomic<int> changed_meanwhile_{0};
  test::GatedBank bank_{registers_,
                        [this](int /*address*/, std::span<const std::uint16_t> values) {
                          if (changed_meanwhile_ > 0) {
                            --changed_meanwhile_;
                            registers_.words_[0] |= 0x10;
                            return test::kBusy;
                          }
                          const bool put_off = puts_off_bit_ && (values.front() & 1U) != 0;
                          return put_off ? test::kBusy : sim::ModbusException::kNone;
                        },
                        [this](int /*address*/, std::span<std::uint16_t> /*values*/) {
                          return puts_off_reads_ ? test::kBusy : sim::ModbusException::kNone;
                        }};
  sim::FaultScript no_faults_;
  test::SimulatedLine line_{Transport::kTcp, bank_, no_faults_};
};

TEST_F(ABusyDrive, IsNotWaitedForByASequenceThatIsAskedToStop) {
  ModbusLink link(patient());
  puts_off_reads_ = true;
  const DriveRegister reg = word_at(0);
  const auto branch = std::make_shared<BranchStep>(BranchStep{is_set(reg), {}, {}});
  for (const DriveStep& step :
       {DriveStep{WaitStep{is_set(reg), milliseconds(100)}}, DriveStep{ExpectStep{{{reg, std::int64_t{1}}}}},
        DriveStep{ModifyStep{reg, 1, 0}}, DriveStep{std::shared_ptr<const BranchStep>(branch)}}) {
    EXPECT_EQ(stopped(link, step).outcome, ModbusOutcome::kUnknown);
  }
}

TEST_F(ABusyDrive, IsSentNoEdgeByAStoppedPulseAndKeepsNone) {
  ModbusLink link(patient());
  registers_.words_[0] = 0x20;
  puts_off_bit_ = true;
  EXPECT_EQ(stopped(link, PulseStep{word_at(0), 1, milliseconds(5), milliseconds(5)}).outcome, ModbusOutcome::kUnknown);
  EXPECT_EQ(registers_.words_[0], 0x20);
}

TEST_F(ABusyDrive, ClearsTheBitOfAPulseThatWasStoppedWhileItWasSet) {
  ModbusLink link(patient());
  std::stop_source stop;
  const DriveSequence sequence{PulseStep{word_at(0), 1, milliseconds(60000), milliseconds(5)}};
  auto running = std::async(
      std::launch::async, [&] { return run_sequence(link, sequence, {}, ModbusPriority::kNormal, stop.get_token()); });
  while (registers_.words_[0] != 1) std::this_thread::yield();
  const auto before = link.stats().later;
  puts_off_reads_ = true;
  stop.request_stop();
  const auto put_off = [&] { return link.stats().later >= before + 3; };
  while (!put_off() && running.wait_for(milliseconds(1)) != std::future_status::ready) std::this_thread::yield();
  puts_off_reads_ = false;
  EXPECT_EQ(running.get().outcome, ModbusOutcome::kUnknown);
  EXPECT_EQ(registers_.words_[0], 0);
}

TEST_F(ABusyDrive, KeepsTheBitsThatOthersSetWhileAChangeIsPutOff) {
  ModbusLink link(patient());
  changed_meanwhile_ = 1;
  const DriveSequence sequence{ModifyStep{word_at(0), 1, 0}};
  EXPECT_EQ(run_sequence(link, sequence, {}, ModbusPriority::kNormal, {}).outcome, ModbusOutcome::kOk);
  EXPECT_EQ(registers_.words_[0], 0x11);
}

}  // namespace
}  // namespace fvd
