#include "sim/drives/ar_drive.hpp"

#include "tests/sim/drives/drive_fixture.hpp"

namespace fvd::sim {
namespace {

constexpr int kInput = 0x007D;
constexpr int kOutput = 0x007F;
constexpr unsigned kHomeP = 1U << 4U;
constexpr unsigned kReady = 1U << 5U;
constexpr unsigned kAlarm = 1U << 7U;
constexpr unsigned kMove = 1U << 13U;
constexpr unsigned kEnd = 1U << 14U;
constexpr int kStart = 1 << 3;
constexpr int kHome = 1 << 4;
constexpr int kStop = 1 << 5;

class AnArDrive : public test::DriveTest<ArDrive> {
 protected:
  void pulse(int bits, int ms = 5) {
    client_.write(kInput, bits);
    pass_ms(ms);
    client_.write(kInput, 0);
  }
  void home() {
    pulse(kHome);
    rest();
  }
  void prepare(int target, int number = 0, int mode = 1) {
    client_.write(0x0400 + 2 * number, test::words_of(target));
    client_.write(0x0480 + 2 * number, test::words_of(50000));
    client_.write(0x0500 + 2 * number, test::words_of(mode));
    client_.write(0x0600 + 2 * number, test::words_of(2000000));
    client_.write(0x0680 + 2 * number, test::words_of(2000000));
  }
  unsigned output() { return client_.word(kOutput); }
};

TEST_F(AnArDrive, HomesAndMovesByPulses) {
  EXPECT_EQ(output() & kHomeP, 0U);
  home();
  EXPECT_EQ(output(), kHomeP | kReady | kEnd);
  prepare(4321);
  EXPECT_FALSE(moves()) << "data alone starts nothing";
  pulse(kStart);
  pass_ms(5);
  EXPECT_EQ(output() & (kMove | kEnd | kReady), kMove);
  rest();
  EXPECT_EQ(client_.value(0x00CC), 4321);
  EXPECT_EQ(client_.value(0x00C6), 4321);
}

TEST_F(AnArDrive, DoesNotSeeAPulseThatIsTooShort) {
  home();
  prepare(1000);
  pulse(kStart, 3);
  rest();
  EXPECT_EQ(drive_.moves(), 0);
  pulse(kStart, 4);
  rest();
  EXPECT_EQ(drive_.moves(), 1);
}

TEST_F(AnArDrive, StartsOnceForALevelThatStays) {
  home();
  prepare(100, 0, 0);
  client_.write(kInput, kStart);
  rest();
  client_.write(kInput, kStart);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 100);
  client_.write(kInput, 0);
  pulse(kStart);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 200) << "incremental";
}

TEST_F(AnArDrive, TakesTheDataThatItsInputsName) {
  home();
  prepare(100, 0);
  prepare(500, 5);
  pulse(kStart | 5);
  rest();
  EXPECT_EQ(client_.value(0x00C6), 500);
}

TEST_F(AnArDrive, StopsAndHoldsWhileStopStands) {
  home();
  prepare(20000);
  pulse(kStart);
  pass_ms(100);
  client_.write(kInput, kStop);
  rest();
  const int stopped = client_.value(0x00C6);
  EXPECT_GT(stopped, 0);
  EXPECT_LT(stopped, 20000);
  client_.write(kInput, kStop | kStart);
  rest();
  client_.read(kOutput, 1);
  EXPECT_EQ(drive_.moves(), 1);
}

TEST_F(AnArDrive, ResetsItsAlarmOnAnEdge) {
  home();
  prepare(500);
  drive_.raise_alarm(0x10);
  EXPECT_EQ(client_.value(0x0080), 0x10);
  EXPECT_EQ(output() & (kAlarm | kReady), kAlarm);
  pulse(kStart);
  rest();
  EXPECT_EQ(drive_.moves(), 0);
  client_.write(0x0180, test::words_of(1));
  EXPECT_EQ(client_.value(0x0080), 0);
  drive_.raise_alarm(0x10);
  client_.write(0x0180, test::words_of(1));
  EXPECT_EQ(client_.value(0x0080), 0x10) << "it stood at 1 already";
  client_.write(0x0180, test::words_of(0));
  client_.write(0x0180, test::words_of(1));
  EXPECT_EQ(client_.value(0x0080), 0);
}

TEST_F(AnArDrive, StopsWithAnAlarmWhenNobodyAsksAnyMore) {
  home();
  prepare(100000);
  client_.write(0x1200, test::words_of(200));
  pulse(kStart);
  for (int i = 0; i < 3; ++i) {
    pass_ms(190);
    EXPECT_EQ(client_.value(0x0080), 0);
  }
  pass_ms(250);
  drive_.idle();
  pass_ms(1000);
  EXPECT_FALSE(moves()) << "it stops by itself, not when it is asked";
  EXPECT_EQ(client_.value(0x0080), 0x85);
  EXPECT_LT(client_.value(0x00C6), 100000);
}

TEST_F(AnArDrive, WaitsForEverWithoutATimeout) {
  home();
  EXPECT_EQ(client_.value(0x0080), 0);
}

TEST_F(AnArDrive, RefusesTargetsBeyondItsLimitsWithAnAlarm) {
  home();
  client_.write(0x0386, test::words_of({1, 1000, -1000}));
  prepare(-1001);
  pulse(kStart);
  EXPECT_EQ(client_.value(0x0080), 0x67);
  EXPECT_EQ(drive_.moves(), 0);
}

TEST_F(AnArDrive, RefusesRegistersThatItHasNot) {
  EXPECT_EQ(client_.try_read(0x0700, 1), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_read(0x06FF, 2), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_read(0x1204, 1), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_write(0x00CC, test::words_of(0)), ModbusException::kIllegalAddress);
}

TEST_F(AnArDrive, LosesReferenceAndDataWithItsPower) {
  home();
  prepare(500);
  drive_.power_cycle();
  EXPECT_EQ(output() & kHomeP, 0U);
  EXPECT_EQ(client_.value(0x0400), 0);
}

}  // namespace
}  // namespace fvd::sim
