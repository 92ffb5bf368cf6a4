/// Requests and answers as bytes, against the examples of the specification (Modbus Application Protocol V1.1b3).

#include "drivers/modbus/modbus_pdu.hpp"

#include "gtest/gtest.h"

namespace fvd {
namespace {

using Pdu = std::vector<std::uint8_t>;

PduAnswer judge(const ModbusRequest& request, const Pdu& answer, std::vector<std::uint16_t>* values = nullptr) {
  std::vector<std::uint16_t> read;
  std::string error;
  const PduAnswer judged = judge_answer(request, request_pdu(request), answer, read, error);
  EXPECT_EQ(error.empty(), judged == PduAnswer::kOk) << error;
  if (values != nullptr) *values = read;
  return judged;
}

TEST(AModbusRequest, IsWhatTheSpecificationShows) {
  EXPECT_EQ(request_pdu({ModbusTable::kCoil, 0x0013, 0x13, {}, false}), (Pdu{0x01, 0x00, 0x13, 0x00, 0x13}));
  EXPECT_EQ(request_pdu({ModbusTable::kDiscrete, 0x00C4, 0x16, {}, false}), (Pdu{0x02, 0x00, 0xC4, 0x00, 0x16}));
  EXPECT_EQ(request_pdu({ModbusTable::kHolding, 0x006B, 3, {}, false}), (Pdu{0x03, 0x00, 0x6B, 0x00, 0x03}));
  EXPECT_EQ(request_pdu({ModbusTable::kInput, 0x0008, 1, {}, false}), (Pdu{0x04, 0x00, 0x08, 0x00, 0x01}));
  EXPECT_EQ(request_pdu({ModbusTable::kCoil, 0x00AC, 0, {1}, true}), (Pdu{0x05, 0x00, 0xAC, 0xFF, 0x00}));
  EXPECT_EQ(request_pdu({ModbusTable::kHolding, 0x0001, 0, {3}, true}), (Pdu{0x06, 0x00, 0x01, 0x00, 0x03}));
  EXPECT_EQ(request_pdu({ModbusTable::kCoil, 0x0013, 0, {1, 0, 1, 1, 0, 0, 1, 1, 1, 0}, false}),
            (Pdu{0x0F, 0x00, 0x13, 0x00, 0x0A, 0x02, 0xCD, 0x01}));
  EXPECT_EQ(request_pdu({ModbusTable::kHolding, 0x0001, 0, {0x000A, 0x0102}, false}),
            (Pdu{0x10, 0x00, 0x01, 0x00, 0x02, 0x04, 0x00, 0x0A, 0x01, 0x02}));
}

TEST(AModbusAnswer, GivesTheValuesOfARead) {
  std::vector<std::uint16_t> values;
  EXPECT_EQ(judge({ModbusTable::kHolding, 0x006B, 3, {}, false}, {3, 6, 0x02, 0x2B, 0x00, 0x00, 0x00, 0x64}, &values),
            PduAnswer::kOk);
  EXPECT_EQ(values, (std::vector<std::uint16_t>{0x022B, 0, 0x64}));
  EXPECT_EQ(judge({ModbusTable::kCoil, 0x0013, 10, {}, false}, {1, 2, 0xCD, 0x01}, &values), PduAnswer::kOk);
  EXPECT_EQ(values, (std::vector<std::uint16_t>{1, 0, 1, 1, 0, 0, 1, 1, 1, 0}));
}

TEST(AModbusAnswer, OfAWriteRepeatsWhatWasAsked) {
  const ModbusRequest write{ModbusTable::kHolding, 1, 0, {10, 258}, false};
  EXPECT_EQ(judge(write, {0x10, 0, 1, 0, 2}), PduAnswer::kOk);
  EXPECT_EQ(judge(write, {0x10, 0, 2, 0, 2}), PduAnswer::kNone) << "another address";
  EXPECT_EQ(judge(write, {0x10, 0, 1, 0, 1}), PduAnswer::kNone) << "another count";
  EXPECT_EQ(judge({ModbusTable::kHolding, 1, 0, {3}, true}, {6, 0, 1, 0, 4}), PduAnswer::kNone) << "another value";
}

TEST(AModbusAnswer, ThatDoesNotFitIsNone) {
  const ModbusRequest read{ModbusTable::kHolding, 0, 2, {}, false};
  for (const Pdu& answer : {Pdu{}, Pdu{3}, Pdu{3, 4}, Pdu{3, 4, 0, 1, 0}, Pdu{3, 2, 0, 1}, Pdu{4, 4, 0, 1, 0, 1},
                            Pdu{0x83}, Pdu{0x84, 6}}) {
    EXPECT_EQ(judge(read, answer), PduAnswer::kNone);
  }
}

TEST(AModbusException, IsARefusalOrALater) {
  const ModbusRequest read{ModbusTable::kHolding, 0, 2, {}, false};
  for (const int code : {1, 2, 3, 4, 7, 8, 0x11, 0xFF}) {
    EXPECT_EQ(judge(read, {0x83, static_cast<std::uint8_t>(code)}), PduAnswer::kException) << code;
  }
  for (const int code : {5, 6, 0x0A, 0x0B}) {
    EXPECT_EQ(judge(read, {0x83, static_cast<std::uint8_t>(code)}), PduAnswer::kLater) << code;
  }
  EXPECT_EQ(exception_text(6), "exception 6: busy");
  EXPECT_EQ(exception_text(0x12), "exception 18: of the maker's own");
}

}  // namespace
}  // namespace fvd
