#include "sim/drives/leadshine_drive.hpp"

#include "tests/sim/drives/drive_fixture.hpp"

namespace fvd::sim {
namespace {

using test::Words;

constexpr unsigned kFault = 1U << 0U;
constexpr unsigned kEnabled = 1U << 1U;
constexpr unsigned kRunning = 1U << 2U;
constexpr unsigned kDone = (1U << 4U) | (1U << 5U);
constexpr unsigned kHomed = 1U << 6U;

class ALeadshineDrive : public test::DriveTest<LeadshineDrive> {
 protected:
  void enable() { client_.write(0x000F, 1); }
  void home() {
    enable();
    client_.write(0x6002, 0x20);
    rest();
  }
  static Words path(int target, unsigned mode = 1, std::uint16_t rpm = 300) {
    const Words position = test::words_of(target);
    return {static_cast<std::uint16_t>(mode), position[0], position[1], rpm, 100, 100, 0, 0};
  }
  void send_to(int target, unsigned mode = 1) {
    Words words = path(target, mode);
    words[7] = 0x10;
    client_.write(0x6200, words);
  }
  unsigned status() { return client_.word(0x1003); }
};

TEST_F(ALeadshineDrive, MovesByOneFrameOnceEnabledAndHomed) {
  EXPECT_EQ(status(), kDone);
  home();
  EXPECT_EQ(status(), kEnabled | kDone | kHomed);
  send_to(12345);
  pass_ms(10);
  EXPECT_EQ(status(), kEnabled | kRunning | kHomed);
  EXPECT_EQ(client_.word(0x6002), 0x100);
  rest();
  EXPECT_EQ(client_.value(0x1012), 12345);
  EXPECT_EQ(client_.value(0x1014), 12345);
  EXPECT_EQ(client_.word(0x6002), 0);
}

TEST_F(ALeadshineDrive, TurnsAtTheSpeedOfItsRpm) {
  home();
  send_to(100000);
  pass_ms(500);
  const int before = client_.value(0x1012);
  pass_ms(100);
  // 300 rpm at 10000 pulses a turn.
  EXPECT_NEAR(client_.value(0x1012) - before, 5000, 2);
}

TEST_F(ALeadshineDrive, TakesItsAccelerationAsATime) {
  home();
  send_to(100000);
  // 100 ms per 1000 rpm: 30 ms to 300 rpm, half of 50 steps/ms on the way.
  pass_ms(3 + 30);
  EXPECT_NEAR(client_.value(0x1012), 750, 2);
}

TEST_F(ALeadshineDrive, DoesNothingWhileDisabled) {
  send_to(1000);
  client_.write(0x6002, 0x20);
  rest();
  EXPECT_EQ(drive_.moves(), 0);
  EXPECT_EQ(status() & kHomed, 0U);
}

TEST_F(ALeadshineDrive, MovesNothingAtSpeedZero) {
  home();
  Words words = path(1000, 1, 0);
  words[7] = 0x10;
  client_.write(0x6200, words);
  rest();
  EXPECT_EQ(drive_.moves(), 0);
}

TEST_F(ALeadshineDrive, StartsAnyPathByItsTrigger) {
  home();
  client_.write(0x6200 + 8 * 3, path(700));
  EXPECT_EQ(drive_.moves(), 0);
  client_.write(0x6002, 0x13);
  pass_ms(10);
  EXPECT_EQ(client_.word(0x6002), 0x103);
  rest();
  EXPECT_EQ(client_.value(0x1012), 700);
  send_to(-100, 0x41);
  rest();
  EXPECT_EQ(client_.value(0x1012), 600) << "relative";
}

TEST_F(ALeadshineDrive, IsInterruptedOnlyByAPathThatMay) {
  home();
  send_to(50000);
  pass_ms(50);
  send_to(0);
  pass_ms(1);
  EXPECT_EQ(drive_.moves(), 1);
  send_to(20000, 0x11);
  rest();
  EXPECT_EQ(client_.value(0x1012), 20000);
}

TEST_F(ALeadshineDrive, StopsQuickly) {
  home();
  send_to(50000);
  pass_ms(100);
  client_.write(0x6002, 0x40);
  rest();
  EXPECT_GT(client_.value(0x1012), 0);
  EXPECT_LT(client_.value(0x1012), 50000);
}

TEST_F(ALeadshineDrive, DoesNothingInAlarmUntilItIsReset) {
  home();
  drive_.raise_alarm(0x180);
  EXPECT_EQ(client_.word(0x2203), 0x180);
  EXPECT_EQ(status() & (kFault | kEnabled), kFault);
  send_to(500);
  rest();
  EXPECT_EQ(drive_.moves(), 0);
  client_.write(0x1801, 0x1111);
  EXPECT_EQ(status() & (kFault | kEnabled), kEnabled);
  send_to(500);
  rest();
  EXPECT_EQ(client_.value(0x1012), 500);
}

TEST_F(ALeadshineDrive, WantsItsJogWrittenAnewEvery50Ms) {
  home();
  for (int i = 0; i < 5; ++i) {
    client_.write(0x1801, 0x4001);
    pass_ms(40);
    EXPECT_NE(status() & kRunning, 0U);
  }
  pass_ms(100);
  drive_.idle();
  EXPECT_FALSE(moves());
}

TEST_F(ALeadshineDrive, MarksASavedMemoryOnce) {
  client_.write(0x1801, 0x2211);
  EXPECT_EQ(client_.word(0x1901), 0x5555);
  EXPECT_EQ(client_.word(0x1901), 0);
}

TEST_F(ALeadshineDrive, SetsItsPositionToZero) {
  home();
  send_to(500);
  rest();
  client_.write(0x6002, 0x21);
  EXPECT_EQ(client_.value(0x1014), 0);
}

TEST_F(ALeadshineDrive, StopsAtLimitsWithAnAlarm) {
  home();
  client_.write(0x6006, Words{0, 1000, 0xFFFF, 0xFC18});
  client_.write(0x6000, 2);
  send_to(-1001);
  EXPECT_EQ(client_.word(0x2203), 0x260);
  EXPECT_EQ(drive_.moves(), 0);
  client_.write(0x1801, 0x1111);
  send_to(-1000);
  rest();
  EXPECT_EQ(client_.value(0x1012), -1000);
}

TEST_F(ALeadshineDrive, TakesParametersAsPairs) {
  EXPECT_EQ(client_.try_write(0x000E, 1), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_write(0x000F, Words{1, 0}), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_write(0x000E, Words{0, 1}), ModbusException::kNone);
  EXPECT_EQ(status() & kEnabled, kEnabled);
  EXPECT_EQ(client_.try_read(0x0001, 2), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.value(0x0000), 10000);
}

TEST_F(ALeadshineDrive, RefusesRegistersThatItHasNot) {
  for (const int address : {0x0200, 0x1050, 0x1800, 0x2202, 0x6030, 0x6280, 0xFFFF}) {
    EXPECT_EQ(client_.try_read(address, 1), ModbusException::kIllegalAddress) << address;
  }
  EXPECT_EQ(client_.try_write(0x1003, 1), ModbusException::kIllegalAddress);
}

}  // namespace
}  // namespace fvd::sim
