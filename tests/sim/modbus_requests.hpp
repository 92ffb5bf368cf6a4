#pragma once

/// Request PDUs, and a client that has no line: it hands them straight to a bank.

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "gtest/gtest.h"
#include "sim/modbus_responder.hpp"

namespace fvd::sim::test {

using Words = std::vector<std::uint16_t>;

inline void append_word(ModbusBytes& bytes, int value) {
  bytes.push_back(static_cast<std::uint8_t>((value >> 8) & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
}

/// Function codes 1 to 6: two words.
inline ModbusBytes short_request(std::uint8_t function, int first, int second) {
  ModbusBytes pdu{function};
  append_word(pdu, first);
  append_word(pdu, second);
  return pdu;
}

inline ModbusBytes write_request(int address, const Words& values) {
  ModbusBytes pdu = short_request(16, address, static_cast<int>(values.size()));
  pdu.push_back(static_cast<std::uint8_t>(2 * values.size()));
  for (const auto value : values) append_word(pdu, value);
  return pdu;
}

/// A 32-bit value, high word first.
inline Words words_of(std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  return {static_cast<std::uint16_t>(bits >> 16U), static_cast<std::uint16_t>(bits & 0xFFFFU)};
}

inline Words words_of(std::initializer_list<std::int32_t> values) {
  Words words;
  for (const auto value : values) {
    const Words pair = words_of(value);
    words.insert(words.end(), pair.begin(), pair.end());
  }
  return words;
}

inline bool is_exception(const ModbusBytes& reply, ModbusException exception) {
  return reply.size() == 2 && (reply[0] & 0x80U) != 0 && reply[1] == static_cast<std::uint8_t>(exception);
}

class BankClient {
 public:
  explicit BankClient(RegisterBank& bank) : bank_(bank) {}

  Words read(int address, int count) {
    const ModbusBytes reply = respond(bank_, short_request(3, address, count));
    if (reply.size() != static_cast<std::size_t>(2 + 2 * count)) {
      ADD_FAILURE() << "reading " << count << " from " << address << " is refused with " << int{reply.back()};
      return Words(static_cast<std::size_t>(count));
    }
    Words words;
    for (std::size_t i = 2; i < reply.size(); i += 2) {
      words.push_back(static_cast<std::uint16_t>((reply[i] << 8U) | reply[i + 1]));
    }
    return words;
  }

  std::uint16_t word(int address) { return read(address, 1)[0]; }

  std::int32_t value(int address) {
    const Words words = read(address, 2);
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(words[0]) << 16U) | words[1]);
  }

  void write(int address, const Words& values) {
    const ModbusException exception = try_write(address, values);
    EXPECT_EQ(exception, ModbusException::kNone) << "writing " << values.size() << " to " << address;
  }

  void write(int address, int value) {
    const ModbusBytes reply = respond(bank_, short_request(6, address, value));
    EXPECT_EQ(reply.size(), 5U) << "writing to " << address << " is refused with " << int{reply.back()};
  }

  ModbusException try_read(int address, int count) {
    return exception_in(respond(bank_, short_request(3, address, count)));
  }
  ModbusException try_write(int address, const Words& values) {
    return exception_in(respond(bank_, write_request(address, values)));
  }
  ModbusException try_write(int address, int value) {
    return exception_in(respond(bank_, short_request(6, address, value)));
  }

 private:
  static ModbusException exception_in(const ModbusBytes& reply) {
    return (reply[0] & 0x80U) != 0 ? static_cast<ModbusException>(reply[1]) : ModbusException::kNone;
  }

  RegisterBank& bank_;
};

/// 100 registers from address 0 and 32 coils, nothing else.
class PlainBank final : public RegisterBank {
 public:
  [[nodiscard]] ModbusException read(int address, std::span<std::uint16_t> values) override {
    if (address + values.size() > registers.size()) return ModbusException::kIllegalAddress;
    for (auto& value : values) value = registers[static_cast<std::size_t>(address++)];
    return ModbusException::kNone;
  }
  [[nodiscard]] ModbusException write(int address, std::span<const std::uint16_t> values) override {
    if (address + values.size() > registers.size()) return ModbusException::kIllegalAddress;
    ++writes;
    for (const auto value : values) registers[static_cast<std::size_t>(address++)] = value;
    return ModbusException::kNone;
  }
  [[nodiscard]] ModbusException read_bits(int address, std::span<std::uint8_t> bits) override {
    if (address + bits.size() > coils.size()) return ModbusException::kIllegalAddress;
    for (auto& bit : bits) bit = coils[static_cast<std::size_t>(address++)];
    return ModbusException::kNone;
  }
  [[nodiscard]] ModbusException write_bits(int address, std::span<const std::uint8_t> bits) override {
    if (address + bits.size() > coils.size()) return ModbusException::kIllegalAddress;
    for (const auto bit : bits) coils[static_cast<std::size_t>(address++)] = bit;
    return ModbusException::kNone;
  }

  Words registers = Words(100);
  std::vector<std::uint8_t> coils = std::vector<std::uint8_t>(32);
  int writes = 0;
};

}  // namespace fvd::sim::test
