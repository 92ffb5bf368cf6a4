/// A drive whose 32-bit words come in another order than its profile says is neither believed nor moved.

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/modbus/drive_check.hpp"
#include "drivers/modbus/drive_profile.hpp"
#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"
#include "tests/support/gated_bank.hpp"
#include "tests/support/simulated_drive.hpp"

namespace fvd {
namespace {

/// Exchanges the words of every pair, both ways.
class ExchangedWords final : public sim::RegisterBank {
 public:
  explicit ExchangedWords(sim::RegisterBank& drive) : drive_(drive) {}
  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    const auto exception = drive_.read(address, values);
    exchange(values);
    return exception;
  }
  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    std::vector<std::uint16_t> words(values.begin(), values.end());
    exchange(words);
    ++writes_;
    return drive_.write(address, words);
  }
  [[nodiscard]] int writes() const noexcept { return writes_; }

 private:
  static void exchange(std::span<std::uint16_t> words) {
    if (words.size() % 2 != 0) return;
    for (std::size_t i = 0; i < words.size(); i += 2) std::swap(words[i], words[i + 1]);
  }

  sim::RegisterBank& drive_;
  std::atomic<int> writes_{0};
};

class ADriveWithExchangedWords : public testing::Test {
 protected:
  ADriveWithExchangedWords() {
    plant_.open_homed().reset();
    plant_.axis().move_to(HostClock::now(), 500, 1e5, 1e6, 1e6);  // 5 um
    while (plant_.axis().true_position_um(HostClock::now()) < 4.5 || plant_.axis().moving(HostClock::now())) {
      std::this_thread::yield();
    }
  }
  [[nodiscard]] StageConfig config() const {
    StageConfig config = plant_.config();
    config.port = std::get<ModbusTcpEndpoint>(line_.config().endpoint).port;
    return config;
  }
  static sim::AxisParameters silent_axis() {
    sim::AxisParameters parameters = test::good_axis();
    parameters.encoder_noise_um = 0.0;
    parameters.settle_noise_um = 0.0;
    return parameters;
  }

  test::SimulatedDrive plant_{test::kDriveCases[0], test::Transport::kTcp, silent_axis()};
  ExchangedWords bank_{plant_.drive()};
  sim::FaultScript no_faults_;
  test::SimulatedLine line_{test::Transport::kTcp, bank_, no_faults_};
};

TEST_F(ADriveWithExchangedWords, IsCalledThatByTheCheck) {
  const DriveProfile profile = load_drive_profile(config().profile);
  ModbusLink link(modbus_link_config(config()));
  const DriveCheck check = check_drive(profile, link);
  ASSERT_EQ(check.disagreements.size(), 1U);
  EXPECT_THAT(check.disagreements.front(),
              testing::AllOf(testing::HasSubstr("exchanged"), testing::HasSubstr("actual_position"),
                             testing::HasSubstr("/word_order")));
}

TEST_F(ADriveWithExchangedWords, IsNotHomed) {
  const auto stage = open_modbus_stage(config());
  const int before = bank_.writes();
  test::expect_error(ErrorCode::kBadConfig, {"exchanged", "Nothing was moved"}, [&] { stage->home({}); });
  EXPECT_EQ(bank_.writes(), before);
  EXPECT_FALSE(plant_.axis().moving(HostClock::now()));
}

TEST(ADriveWithItsWordsInOrder, IsNotSuspected) {
  for (const test::DriveCase& drive : test::kDriveCases) {
    const test::SimulatedDrive plant(drive, test::Transport::kTcp);
    const DriveProfile profile = load_drive_profile(plant.config().profile);
    ModbusLink link(modbus_link_config(plant.config()));
    EXPECT_THAT(check_drive(profile, link).disagreements, testing::IsEmpty()) << drive;
  }
}

TEST(ADriveThatKeepsItsLastErrorCode, IsHomedAllTheSame) {
  constexpr int kErrorCode = 5007;
  test::SimulatedDrive plant(test::kDriveCases[4], test::Transport::kTcp);
  test::GatedBank bank(plant.drive(), {}, [](int address, std::span<std::uint16_t> values) {
    if (address == kErrorCode) values.front() = 0x2310;
    return sim::ModbusException::kNone;
  });
  sim::FaultScript no_faults;
  const test::SimulatedLine line(test::Transport::kTcp, bank, no_faults);
  StageConfig config = plant.config();
  config.port = std::get<ModbusTcpEndpoint>(line.config().endpoint).port;
  {
    ModbusLink link(modbus_link_config(config));
    const DriveCheck check = check_drive(load_drive_profile(config.profile), link);
    EXPECT_THAT(check.doubts, testing::ElementsAre(testing::HasSubstr("without the alarm bit")));
    EXPECT_THAT(check.disagreements, testing::IsEmpty());
  }
  EXPECT_NO_THROW(open_modbus_stage(config)->home({}));
}

}  // namespace
}  // namespace fvd
