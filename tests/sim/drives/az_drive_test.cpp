#include "sim/drives/az_drive.hpp"

#include "tests/sim/drives/drive_fixture.hpp"

namespace fvd::sim {
namespace {

constexpr int kOutput = 0x007F;
constexpr unsigned kHomeEnd = 1U << 4U;
constexpr unsigned kReady = 1U << 5U;
constexpr unsigned kAlarm = 1U << 7U;
constexpr unsigned kMove = 1U << 13U;
constexpr unsigned kInPosition = 1U << 14U;

class AnAzDrive : public test::DriveTest<AzDrive> {
 protected:
  void send_to(int target, int type = 1) {
    client_.write(0x0058, test::words_of({0, type, target, 50000, 2000000, 2000000, 1000, 1, 0}));
  }
  void home() {
    client_.write(0x0079, 1 << 4);
    rest();
  }
  unsigned output() { return client_.word(kOutput); }
};

TEST_F(AnAzDrive, HomesByAnInputThatSwitchesItselfOff) {
  EXPECT_EQ(output() & kHomeEnd, 0U);
  client_.write(0x0079, 1 << 4);
  EXPECT_EQ(client_.word(0x0079), 0);
  pass_ms(10);
  EXPECT_NE(output() & kMove, 0U);
  rest();
  EXPECT_EQ(output(), kHomeEnd | kReady | kInPosition);
  EXPECT_EQ(client_.value(0x00CC), 0);
}

TEST_F(AnAzDrive, MovesByOneFrame) {
  home();
  send_to(1234);
  pass_ms(1);
  EXPECT_NE(output() & kInPosition, 0U) << "stale before the motion starts";
  pass_ms(5);
  EXPECT_EQ(output() & (kMove | kInPosition | kReady), kMove);
  rest();
  EXPECT_EQ(client_.value(0x00CC), 1234);
  EXPECT_EQ(client_.value(0x00C6), 1234);
  send_to(-34, 2);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 1200);
  EXPECT_EQ(drive_.moves(), 2);
}

TEST_F(AnAzDrive, MayHaveItsWordsTheOtherWayRound) {
  drive_.set_low_word_first();
  home();
  client_.write(0x0058, {0, 0, 1, 0, 1234, 0, 50000, 0, 0x8480, 0x1E, 0x8480, 0x1E, 1000, 0, 1, 0, 0, 0});
  rest();
  EXPECT_EQ(client_.read(0x00CC, 2), (test::Words{1234, 0}));
  EXPECT_EQ(drive_.moves(), 1);
  drive_.exchange_words(true);
  EXPECT_EQ(client_.read(0x00CC, 2), (test::Words{0, 1234}));
  drive_.exchange_words(false);
  EXPECT_EQ(client_.read(0x00CC, 2), (test::Words{1234, 0}));
}

TEST_F(AnAzDrive, StartsByTheItemThatANegativeTriggerNames) {
  home();
  send_to(100);
  rest();
  client_.write(0x0066, test::words_of(-5));
  client_.write(0x005C, test::words_of(700));
  rest();
  EXPECT_EQ(client_.value(0x00C6), 700);
}

TEST_F(AnAzDrive, StopsOnTheEdgeOfItsInput) {
  home();
  send_to(20000);
  pass_ms(100);
  client_.write(0x007D, 1 << 5);
  rest();
  const int stopped = client_.value(0x00C6);
  EXPECT_GT(stopped, 0);
  EXPECT_LT(stopped, 20000);
  send_to(20000);
  rest();
  EXPECT_EQ(client_.value(0x00C6), stopped) << "STOP stands";
  client_.write(0x007D, 0);
  send_to(20000);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 20000);
}

TEST_F(AnAzDrive, DoesNothingInAlarmUntilItIsReset) {
  home();
  drive_.raise_alarm(0x30);
  EXPECT_EQ(client_.value(0x0080), 0x30);
  EXPECT_EQ(output() & (kAlarm | kReady), kAlarm);
  EXPECT_NE(client_.word(0x0179) & (1U << 1U), 0U);
  send_to(500);
  client_.write(0x0079, 1 << 4);
  rest();
  EXPECT_EQ(drive_.moves(), 0);
  client_.write(0x0180, test::words_of(1));
  EXPECT_EQ(output() & (kAlarm | kReady), kReady);
  send_to(500);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 500);
}

TEST_F(AnAzDrive, RefusesTargetsBeyondItsLimitsWithAnAlarm) {
  home();
  client_.write(0x0386, test::words_of({1, 1000, -1000}));
  send_to(1001);
  EXPECT_EQ(client_.value(0x0080), 0x67);
  EXPECT_EQ(drive_.moves(), 0);
}

TEST_F(AnAzDrive, HasAPositionPreset) {
  home();
  client_.write(0x038C, test::words_of(5000));
  client_.write(0x018A, test::words_of(1));
  EXPECT_EQ(client_.value(0x00CC), 5000);
  send_to(5100);
  rest();
  EXPECT_NEAR(axis_.true_position_um(now_), 1.0, 1e-9);
}

TEST_F(AnAzDrive, TellsTheTemperaturesOfDriverAndMotor) {
  EXPECT_EQ(client_.value(0x00F8), 412);
  EXPECT_EQ(client_.value(0x00FA), 385) << "18.5 K above the axis, in 0.1 degC";
}

TEST_F(AnAzDrive, RefusesRegistersThatItHasNot) {
  EXPECT_EQ(client_.try_read(0x0400, 1), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_read(0x03FF, 2), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_write(0x007F, 1), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_write(0x007D, test::Words{0, 0}), ModbusException::kIllegalAddress);
}

TEST_F(AnAzDrive, SaysWhatHappensToItByItsAlarms) {
  home();
  drive_.limit_hit();
  EXPECT_EQ(client_.value(0x0080), 0x66);
  drive_.emergency_stop();
  EXPECT_EQ(client_.value(0x0080), 0x68);
  drive_.power_cycle();
  EXPECT_EQ(client_.value(0x0080), 0);
  EXPECT_EQ(output() & kHomeEnd, 0U);
}

TEST_F(AnAzDrive, RefusesAMoveWithoutAWord) {
  home();
  drive_.refuse_moves(1);
  send_to(500);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 0);
  send_to(500);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 500);
}

TEST_F(AnAzDrive, HoldsInPositionWhileItIsTold) {
  home();
  drive_.hold_in_position(std::chrono::milliseconds(50));
  send_to(20000);
  pass_ms(40);
  EXPECT_TRUE(moves());
  EXPECT_EQ(output() & (kMove | kInPosition), kInPosition);
  pass_ms(20);
  EXPECT_EQ(output() & (kMove | kInPosition), kMove);
}

}  // namespace
}  // namespace fvd::sim
