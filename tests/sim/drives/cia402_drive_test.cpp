#include "sim/drives/cia402_drive.hpp"

#include "tests/sim/drives/drive_fixture.hpp"

namespace fvd::sim {
namespace {

using test::Words;

constexpr unsigned kStateMask = 0x6FU;
constexpr unsigned kTargetReached = 1U << 10U;
constexpr unsigned kLimit = 1U << 11U;
constexpr unsigned kAcknowledged = 1U << 12U;

class ACia402Drive : public test::DriveTest<Cia402Drive> {
 protected:
  void control(int word) { client_.write(6000, word); }
  unsigned status() { return client_.word(5000); }
  unsigned state() { return status() & kStateMask; }

  void enable() {
    control(0x06);
    control(0x07);
    control(0x0F);
  }
  void home() {
    enable();
    client_.write(6001, 6);
    control(0x1F);
    rest();
    control(0x0F);
    client_.write(6001, 1);
  }
  void prepare(int target) {
    client_.write(6002, test::words_of({target, 50000}));
    client_.write(6009, test::words_of({2000000, 2000000}));
  }
  void send_to(int target, int bits = 0) {
    prepare(target);
    control(0x1F | bits);
    control(0x0F | bits);
  }
};

TEST_F(ACia402Drive, IsEnabledStepByStep) {
  EXPECT_EQ(state(), 0x40U);
  control(0x0F);
  EXPECT_EQ(state(), 0x40U) << "not before shutdown";
  control(0x06);
  EXPECT_EQ(state(), 0x21U);
  control(0x07);
  EXPECT_EQ(state(), 0x23U);
  control(0x0F);
  EXPECT_EQ(state(), 0x27U);
  control(0x07);
  EXPECT_EQ(state(), 0x23U);
  control(0x06);
  EXPECT_EQ(state(), 0x21U);
  control(0x00);
  EXPECT_EQ(state(), 0x40U);
}

TEST_F(ACia402Drive, HomesInItsMode) {
  enable();
  client_.write(6001, 6);
  EXPECT_EQ(client_.word(5001), 6);
  EXPECT_EQ(status() & kAcknowledged, 0U);
  control(0x1F);
  pass_ms(10);
  EXPECT_EQ(status() & (kTargetReached | kAcknowledged), 0U);
  rest();
  EXPECT_EQ(status() & (kTargetReached | kAcknowledged), kTargetReached | kAcknowledged);
  EXPECT_EQ(client_.value(5002), 0);
  control(0x0F);
  control(0x1F);
  pass_ms(1);
  EXPECT_EQ(status() & kAcknowledged, 0U) << "not homed any more, from the start of the next homing";
}

TEST_F(ACia402Drive, TakesASetPointByHandshake) {
  home();
  prepare(12345);
  control(0x1F);
  EXPECT_NE(status() & kAcknowledged, 0U);
  control(0x0F);
  EXPECT_EQ(status() & kAcknowledged, 0U);
  pass_ms(10);
  EXPECT_EQ(status() & kTargetReached, 0U);
  control(0x0F);
  rest();
  EXPECT_NE(status() & kTargetReached, 0U);
  EXPECT_EQ(client_.value(5002), 12345);
  EXPECT_EQ(drive_.moves(), 1);
}

TEST_F(ACia402Drive, StartsOnEdgesOnly) {
  home();
  prepare(100);
  control(0x1F);
  rest();
  prepare(200);
  control(0x1F);
  rest();
  EXPECT_EQ(client_.value(5002), 100);
  EXPECT_NE(status() & kAcknowledged, 0U) << "until bit 4 is taken back";
}

TEST_F(ACia402Drive, MovesNothingUnlessItWasEnabled) {
  client_.write(6001, 1);
  control(0x06);
  control(0x07);
  prepare(100);
  control(0x1F);
  rest();
  EXPECT_EQ(state(), 0x27U);
  EXPECT_EQ(drive_.moves(), 0);
}

TEST_F(ACia402Drive, BuffersOneSetPoint) {
  home();
  send_to(20000);
  pass_ms(50);
  send_to(5000);
  EXPECT_NE(status() & kAcknowledged, 0U) << "no room for another";
  send_to(7000);
  rest();
  EXPECT_EQ(status() & kAcknowledged, 0U);
  rest();
  EXPECT_EQ(client_.value(5002), 5000);
  EXPECT_EQ(drive_.moves(), 2);
}

TEST_F(ACia402Drive, ChangesItsTargetAtOnceIfAsked) {
  home();
  send_to(20000);
  pass_ms(50);
  send_to(5000, 0x20);
  EXPECT_EQ(drive_.moves(), 2);
  rest();
  EXPECT_EQ(client_.value(5002), 5000);
}

TEST_F(ACia402Drive, MovesRelatively) {
  home();
  send_to(500);
  rest();
  send_to(-200, 0x40);
  rest();
  EXPECT_EQ(client_.value(5002), 300);
}

TEST_F(ACia402Drive, HaltsAndGoesOn) {
  home();
  send_to(20000);
  pass_ms(100);
  control(0x10F);
  rest();
  EXPECT_LT(client_.value(5002), 20000);
  EXPECT_EQ(state(), 0x27U);
  control(0x0F);
  rest();
  EXPECT_EQ(client_.value(5002), 20000);
}

TEST_F(ACia402Drive, EndsAQuickStopSwitchedOff) {
  home();
  send_to(50000);
  pass_ms(100);
  control(0x02);
  pass_ms(4);
  EXPECT_EQ(state(), 0x07U);
  rest();
  EXPECT_EQ(state(), 0x40U);
  EXPECT_GT(client_.value(5002), 0);
  EXPECT_LT(client_.value(5002), 50000);
}

TEST_F(ACia402Drive, ResetsAFaultOnTheEdgeOfBit7) {
  home();
  send_to(50000);
  control(0x8F);
  pass_ms(50);
  drive_.raise_alarm(0x8611);
  rest();
  EXPECT_EQ(status() & 0x4FU, 0x08U);
  EXPECT_EQ(client_.word(5007), 0x8611);
  control(0x8F);
  EXPECT_EQ(client_.word(5007), 0x8611) << "bit 7 stood";
  control(0x00);
  control(0x80);
  EXPECT_EQ(state(), 0x40U);
  EXPECT_EQ(client_.word(5007), 0);
  enable();
  send_to(100);
  rest();
  EXPECT_EQ(client_.value(5002), 100);
}

TEST_F(ACia402Drive, ShowsALimitUntilTheNextMotion) {
  home();
  send_to(50000);
  pass_ms(100);
  drive_.limit_hit();
  rest();
  EXPECT_NE(status() & kLimit, 0U);
  EXPECT_EQ(client_.value(5005), 2);
  EXPECT_EQ(state(), 0x27U);
  send_to(0);
  EXPECT_EQ(status() & kLimit, 0U);
}

TEST_F(ACia402Drive, LosesItsEnableWithItsTorque) {
  home();
  drive_.emergency_stop();
  EXPECT_EQ(state(), 0x40U);
}

TEST_F(ACia402Drive, TakesNoModeThatItHasNot) {
  client_.write(6001, 1);
  client_.write(6001, 9);
  EXPECT_EQ(client_.word(5001), 1);
}

TEST_F(ACia402Drive, RefusesRegistersThatItHasNot) {
  EXPECT_EQ(client_.try_read(4999, 2), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_read(5007, 2), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_read(6013, 1), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_write(5000, 0), ModbusException::kIllegalAddress);
  EXPECT_EQ(client_.try_write(6012, Words{0, 0}), ModbusException::kIllegalAddress);
}

}  // namespace
}  // namespace fvd::sim
