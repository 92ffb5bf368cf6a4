#include "sim/modbus/modbus_responder.hpp"

#include "gtest/gtest.h"
#include "tests/sim/modbus/modbus_requests.hpp"

namespace fvd::sim {
namespace {

using test::is_exception;
using test::PlainBank;
using test::short_request;
using test::Words;
using test::write_request;

class AResponder : public testing::Test {
 protected:
  AResponder() { bank_.count_up(); }
  ModbusBytes ask(const ModbusBytes& request) { return respond(bank_, request); }

  PlainBank bank_;
};

TEST_F(AResponder, ReadsRegistersByBothFunctionCodes) {
  EXPECT_EQ(ask(short_request(3, 2, 2)), (ModbusBytes{3, 4, 0x01, 0x02, 0x01, 0x03}));
  EXPECT_EQ(ask(short_request(4, 2, 2)), (ModbusBytes{4, 4, 0x01, 0x02, 0x01, 0x03}));
}

TEST_F(AResponder, WritesOneRegisterAndMany) {
  EXPECT_EQ(ask(short_request(6, 5, 0xABCD)), short_request(6, 5, 0xABCD));
  EXPECT_EQ(bank_.at(5), 0xABCD);
  EXPECT_EQ(ask(write_request(7, {1, 2, 3})), short_request(16, 7, 3));
  EXPECT_EQ(bank_.at(9), 3);
}

TEST_F(AResponder, ReadsAndWritesCoils) {
  EXPECT_EQ(ask(short_request(5, 3, 0xFF00)), short_request(5, 3, 0xFF00));
  // Ten coils from 2: bits 0, 3 and 9 of the field.
  EXPECT_EQ(ask({15, 0, 10, 0, 10, 2, 0b00001001, 0b10}), short_request(15, 10, 10));
  EXPECT_EQ(ask(short_request(1, 0, 20)), (ModbusBytes{1, 3, 0b00001000, 0b00100100, 0b1000}));
  EXPECT_EQ(ask(short_request(2, 3, 1)), (ModbusBytes{2, 1, 1}));
  EXPECT_EQ(ask(short_request(5, 3, 0)), short_request(5, 3, 0));
  EXPECT_EQ(ask(short_request(1, 3, 1)), (ModbusBytes{1, 1, 0}));
}

TEST_F(AResponder, WritesBeforeItReadsInOneRequest) {
  EXPECT_EQ(ask({23, 0, 4, 0, 2, 0, 5, 0, 1, 2, 0xAA, 0xBB}), (ModbusBytes{23, 4, 0x01, 0x04, 0xAA, 0xBB}));
}

TEST_F(AResponder, WritesNothingWhenItCannotRead) {
  EXPECT_TRUE(is_exception(ask({23, 0, 4, 0, 0, 0, 5, 0, 1, 2, 0xAA, 0xBB}), ModbusException::kIllegalValue));
  EXPECT_TRUE(is_exception(ask({23, 0, 4, 0, 126, 0, 5, 0, 1, 2, 0xAA, 0xBB}), ModbusException::kIllegalValue));
  EXPECT_EQ(bank_.writes(), 0);
}

TEST_F(AResponder, RefusesAddressesThatTheBankHasNot) {
  for (const auto& request : {short_request(3, 99, 2), short_request(4, 100, 1), short_request(1, 32, 1),
                              short_request(2, 31, 2), short_request(5, 32, 0xFF00), short_request(6, 100, 1),
                              short_request(3, 0xFFFF, 2), write_request(99, {1, 2}), write_request(0xFFFF, {1, 2})}) {
    EXPECT_TRUE(is_exception(ask(request), ModbusException::kIllegalAddress)) << int{request[0]};
  }
  EXPECT_TRUE(is_exception(ask({15, 0, 30, 0, 3, 1, 7}), ModbusException::kIllegalAddress));
}

TEST_F(AResponder, RefusesMalformedRequests) {
  const std::vector<ModbusBytes> malformed{
      short_request(3, 0, 0),
      short_request(3, 0, 126),
      short_request(1, 0, 0),
      short_request(1, 0, 2001),
      short_request(5, 0, 1),
      {3},
      {3, 0, 0, 0},
      {3, 0, 0, 0, 1, 0},
      {6, 0, 0, 0},
      {16},
      {16, 0, 0, 0, 1, 2, 0},
      {16, 0, 0, 0, 1, 3, 0, 0, 0},
      {16, 0, 0, 0, 2, 2, 0, 0},
      {16, 0, 0, 0, 0, 0},
      {15},
      {15, 0, 0, 0, 9, 1, 0},
      {15, 0, 0, 0, 0, 0},
      {15, 0, 0, 0, 8, 1, 0, 0},
      {23, 0, 0, 0, 1, 0, 0, 0, 1},
      {23, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0},
  };
  for (const auto& request : malformed) {
    EXPECT_TRUE(is_exception(ask(request), ModbusException::kIllegalValue))
        << testing::PrintToString(request) << " gives " << testing::PrintToString(ask(request));
  }
  EXPECT_EQ(bank_.writes(), 0);
  EXPECT_TRUE(ask({}).empty());
}

TEST_F(AResponder, RefusesFunctionCodesThatItHasNot) {
  for (const int function : {0, 7, 22, 24, 43, 127}) {
    EXPECT_TRUE(
        is_exception(ask({static_cast<std::uint8_t>(function), 0, 0, 0, 1}), ModbusException::kIllegalFunction));
  }
}

TEST_F(AResponder, ReturnsTheQueryOfADiagnosis) {
  EXPECT_EQ(ask({8, 0, 0, 0x12, 0x34}), (ModbusBytes{8, 0, 0, 0x12, 0x34}));
  EXPECT_EQ(ask({8, 0, 0, 1, 2, 3, 4}), (ModbusBytes{8, 0, 0, 1, 2, 3, 4}));
  EXPECT_TRUE(is_exception(ask({8, 0, 11, 0, 0}), ModbusException::kIllegalFunction)) << "a counter";
  EXPECT_TRUE(is_exception(ask({8, 0, 0}), ModbusException::kIllegalValue));
  EXPECT_TRUE(is_exception(ask({8, 0, 0, 1}), ModbusException::kIllegalValue));
}

TEST(AResponderThatKnowsItself, IsIdentified) {
  struct Named final : RegisterBank {
    [[nodiscard]] ModbusException read(int, std::span<std::uint16_t>) override { return ModbusException::kNone; }
    [[nodiscard]] ModbusException write(int, std::span<const std::uint16_t>) override { return ModbusException::kNone; }
    [[nodiscard]] std::optional<DeviceIdentification> identification() const override {
      return DeviceIdentification{.vendor = "V", .product = "PP", .revision = "3"};
    }
  } bank;
  EXPECT_EQ(respond(bank, ModbusBytes{43, 14, 1, 0}),
            (ModbusBytes{43, 14, 1, 0x81, 0, 0, 3, 0, 1, 'V', 1, 2, 'P', 'P', 2, 1, '3'}));
  EXPECT_EQ(respond(bank, ModbusBytes{43, 14, 3, 2}), (ModbusBytes{43, 14, 3, 0x81, 0, 0, 1, 2, 1, '3'}));
  EXPECT_EQ(respond(bank, ModbusBytes{43, 14, 4, 1}), (ModbusBytes{43, 14, 4, 0x81, 0, 0, 1, 1, 2, 'P', 'P'}));
  EXPECT_EQ(respond(bank, ModbusBytes{43, 14, 1, 9}), respond(bank, ModbusBytes{43, 14, 1, 0}));
  EXPECT_TRUE(is_exception(respond(bank, ModbusBytes{43, 14, 4, 9}), ModbusException::kIllegalAddress));
  EXPECT_TRUE(is_exception(respond(bank, ModbusBytes{43, 14, 5, 0}), ModbusException::kIllegalValue));
  EXPECT_TRUE(is_exception(respond(bank, ModbusBytes{43, 14, 1}), ModbusException::kIllegalValue));
  EXPECT_TRUE(is_exception(respond(bank, ModbusBytes{43}), ModbusException::kIllegalValue));
  EXPECT_TRUE(is_exception(respond(bank, ModbusBytes{43, 13, 1, 0}), ModbusException::kIllegalFunction)) << "CANopen";
}

TEST_F(AResponder, HasNoCoilsUnlessTheBankHas) {
  struct NoCoils final : RegisterBank {
    [[nodiscard]] ModbusException read(int, std::span<std::uint16_t>) override { return ModbusException::kNone; }
    [[nodiscard]] ModbusException write(int, std::span<const std::uint16_t>) override { return ModbusException::kNone; }
  } bank;
  EXPECT_TRUE(is_exception(respond(bank, short_request(1, 0, 1)), ModbusException::kIllegalAddress));
  EXPECT_TRUE(is_exception(respond(bank, short_request(5, 0, 0xFF00)), ModbusException::kIllegalAddress));
}

TEST(RequestSummary, TellsWhatARequestTouches) {
  EXPECT_FALSE(summary_of(short_request(3, 10, 2)).writes);
  EXPECT_TRUE(summary_of(short_request(3, 10, 2)).contains(11));
  EXPECT_FALSE(summary_of(short_request(3, 10, 2)).contains(12));
  EXPECT_TRUE(summary_of(short_request(6, 10, 2)).contains(10));
  EXPECT_FALSE(summary_of(short_request(6, 10, 2)).contains(11));
  const auto both = summary_of(ModbusBytes{23, 0, 4, 0, 2, 0, 50, 0, 1, 2, 0xAA, 0xBB});
  EXPECT_TRUE(both.writes);
  EXPECT_TRUE(both.contains(5));
  EXPECT_TRUE(both.contains(50));
  EXPECT_FALSE(summary_of(ModbusBytes{16, 0}).writes);
}

TEST(ModbusCrc, IsThatOfTheManuals) {
  // Leadshine ELD2 manual, p. 80: 100000 pulses at 500 rpm.
  const ModbusBytes frame{0x11, 0x10, 0x62, 0x00, 0x00, 0x08, 0x10, 0x00, 0x01, 0x00, 0x01, 0x86,
                          0xA0, 0x01, 0xF4, 0x00, 0x64, 0x00, 0x64, 0x00, 0x00, 0x00, 0x10};
  EXPECT_EQ(modbus_crc(frame), 0xB367) << "67 B3 on the line";
}

TEST(RtuFrameLength, FollowsFromTheFunctionCode) {
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1}), 0);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 3}), 8);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 16, 0, 0, 0, 2}), 0);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 16, 0, 0, 0, 2, 4}), 13);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 23, 0, 0, 0, 1, 0, 0, 0, 1, 2}), 15);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 43}), 0);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 43, 14}), 7);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 43, 13}), -1);
  EXPECT_EQ(rtu_frame_length(ModbusBytes{1, 44}), -1);
}

}  // namespace
}  // namespace fvd::sim
