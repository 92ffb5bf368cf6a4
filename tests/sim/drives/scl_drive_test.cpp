#include "sim/drives/scl_drive.hpp"

#include "tests/sim/drives/drive_fixture.hpp"

namespace fvd::sim {
namespace {

using test::Words;

constexpr unsigned kEnabled = 1U << 0U;
constexpr unsigned kFault = 1U << 2U;
constexpr unsigned kInPosition = 1U << 3U;
constexpr unsigned kMoving = 1U << 4U;
constexpr unsigned kAlarm = 1U << 9U;
constexpr unsigned kHoming = 1U << 10U;

class AnSclDrive : public test::DriveTest<SclDrive> {
 protected:
  void opcode(int code) { client_.write(124, code); }
  void home() {
    opcode(0x6E);
    rest();
  }
  void send_to(int target, int code = 0x67) {
    const Words position = test::words_of(target);
    client_.write(27, Words{600, 600, 1200, position[0], position[1]});
    opcode(code);
  }
  unsigned status() { return client_.word(1); }
};

TEST_F(AnSclDrive, HomesAndMovesByItsOpcodes) {
  EXPECT_EQ(status(), kEnabled | kInPosition);
  opcode(0x6E);
  pass_ms(10);
  EXPECT_EQ(status(), kEnabled | kMoving | kHoming);
  rest();
  EXPECT_EQ(client_.value(4), 0);
  send_to(54321);
  pass_ms(10);
  EXPECT_EQ(status(), kEnabled | kMoving);
  rest();
  const Words block = client_.read(0, 10);
  EXPECT_EQ(block[0], 0);
  EXPECT_EQ(block[1], kEnabled | kInPosition);
  for (const int at : {4, 6, 8}) EXPECT_EQ(client_.value(at), 54321) << at;
}

TEST_F(AnSclDrive, TurnsAtTheUnitsOfItsManual) {
  home();
  send_to(1000000);
  pass_ms(3 + 50);
  // 600/6 = 100 rps^2 are 2e6 steps/s^2 at 20000 steps a turn: 50 ms to 1200/240 = 5 rps.
  EXPECT_NEAR(client_.value(6), 2500, 2);
  pass_ms(100);
  EXPECT_NEAR(client_.value(6), 12500, 2);
}

TEST_F(AnSclDrive, MovesRelativelyToItsCommandPosition) {
  home();
  send_to(1000);
  rest();
  send_to(-300, 0x66);
  rest();
  EXPECT_EQ(client_.value(6), 700);
}

TEST_F(AnSclDrive, BuffersAMoveUntilTheOneBeforeHasEnded) {
  home();
  send_to(20000);
  pass_ms(50);
  send_to(5000);
  pass_ms(1);
  EXPECT_EQ(drive_.moves(), 1);
  rest();
  drive_.idle();
  rest();
  EXPECT_EQ(client_.value(6), 5000);
  EXPECT_EQ(drive_.moves(), 2);
}

TEST_F(AnSclDrive, StopsAndForgetsWhatItBuffered) {
  home();
  send_to(50000);
  pass_ms(100);
  opcode(0x67);
  opcode(0xE1);
  rest();
  const int stopped = client_.value(6);
  EXPECT_GT(stopped, 0);
  EXPECT_LT(stopped, 50000);
  rest();
  EXPECT_EQ(client_.value(6), stopped);
}

TEST_F(AnSclDrive, RaisesAnAlarmForAMoveWhileDisabled) {
  home();
  opcode(0x9E);
  EXPECT_EQ(status() & kEnabled, 0U);
  send_to(100);
  EXPECT_EQ(client_.word(0), 1U << 12U);
  EXPECT_EQ(drive_.moves(), 0);
  opcode(0xBA);
  opcode(0x9F);
  send_to(100);
  rest();
  EXPECT_EQ(client_.value(6), 100);
}

TEST_F(AnSclDrive, IsDisabledByAFaultAndEnabledAgainAfterItsReset) {
  home();
  send_to(50000);
  pass_ms(50);
  drive_.raise_alarm(1);
  rest();
  EXPECT_EQ(status() & (kEnabled | kFault | kAlarm | kMoving), kFault | kAlarm);
  opcode(0x9F);
  EXPECT_EQ(status() & kEnabled, 0U) << "not in a fault";
  opcode(0xBA);
  EXPECT_EQ(status() & (kEnabled | kFault | kAlarm), 0U);
  opcode(0x9F);
  send_to(100);
  rest();
  EXPECT_EQ(client_.value(6), 100);
}

TEST_F(AnSclDrive, SaysWhichLimitItHit) {
  home();
  send_to(50000);
  pass_ms(50);
  drive_.limit_hit();
  EXPECT_EQ(client_.word(0), 1U << 2U);
  EXPECT_EQ(status() & kEnabled, kEnabled);
  opcode(0xBA);
  rest();
  send_to(-50000);
  pass_ms(50);
  drive_.limit_hit();
  EXPECT_EQ(client_.word(0), 1U << 1U);
}

TEST_F(AnSclDrive, SetsItsPosition) {
  home();
  client_.write(125, test::words_of(-777));
  opcode(0xA5);
  EXPECT_EQ(client_.value(4), -777);
  send_to(0);
  rest();
  EXPECT_NEAR(axis_.true_position_um(now_), 7.77, 1e-9);
}

TEST_F(AnSclDrive, HasExceptionsOfItsOwn) {
  EXPECT_EQ(client_.try_read(200, 1), ModbusException::kNotReadable);
  EXPECT_EQ(client_.try_read(15, 2), ModbusException::kNotReadable);
  EXPECT_EQ(client_.try_write(1, 0), ModbusException::kNotWritable);
  EXPECT_EQ(client_.try_write(300, 0), ModbusException::kNotWritable);
  EXPECT_EQ(client_.try_write(124, 0x01), ModbusException::kOutOfRange);
  EXPECT_EQ(client_.try_write(29, 32001), ModbusException::kOutOfRange);
  EXPECT_EQ(client_.try_write(27, Words{600, 0, 240, 0, 0}), ModbusException::kOutOfRange);
  EXPECT_EQ(client_.word(29), 240) << "the whole write is refused";
}

TEST_F(AnSclDrive, IsDisabledWithoutTorque) {
  drive_.emergency_stop();
  EXPECT_EQ(status() & (kEnabled | kAlarm), 0U);
}

}  // namespace
}  // namespace fvd::sim
