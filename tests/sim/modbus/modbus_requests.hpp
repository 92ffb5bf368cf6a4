#pragma once

/// Request PDUs, and a client that has no line: it hands them straight to a bank.

#include <cstdint>
#include <initializer_list>
#include <mutex>
#include <numeric>
#include <span>
#include <vector>

#include "gtest/gtest.h"
#include "sim/modbus/modbus_responder.hpp"

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

/// 100 registers from address 0 and 32 coils, nothing else. context: thread-safe.
class PlainBank final : public RegisterBank {
 public:
  /// Register n holds 0x0100 + n.
  void count_up() {
    const std::lock_guard lock(mutex_);
    std::iota(registers_.begin(), registers_.end(), std::uint16_t{0x0100});
  }
  void set(std::size_t at, std::uint16_t value) {
    const std::lock_guard lock(mutex_);
    registers_[at] = value;
  }
  [[nodiscard]] std::uint16_t at(std::size_t at) const {
    const std::lock_guard lock(mutex_);
    return registers_[at];
  }
  /// Writes of registers so far.
  [[nodiscard]] int writes() const {
    const std::lock_guard lock(mutex_);
    return writes_;
  }

  [[nodiscard]] ModbusException read(int address, std::span<std::uint16_t> values) override {
    return copy_out(registers_, address, values);
  }
  [[nodiscard]] ModbusException write(int address, std::span<const std::uint16_t> values) override {
    const auto exception = copy_in(registers_, address, values);
    const std::lock_guard lock(mutex_);
    if (exception == ModbusException::kNone) ++writes_;
    return exception;
  }
  [[nodiscard]] ModbusException read_bits(int address, std::span<std::uint8_t> bits) override {
    return copy_out(coils_, address, bits);
  }
  [[nodiscard]] ModbusException write_bits(int address, std::span<const std::uint8_t> bits) override {
    return copy_in(coils_, address, bits);
  }

 private:
  template <typename Value>
  ModbusException copy_out(const std::vector<Value>& from, int address, std::span<Value> to) const {
    const std::lock_guard lock(mutex_);
    const auto first = static_cast<std::size_t>(address);
    if (first + to.size() > from.size()) return ModbusException::kIllegalAddress;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[first + i];
    return ModbusException::kNone;
  }
  template <typename Value>
  ModbusException copy_in(std::vector<Value>& to, int address, std::span<const Value> from) {
    const std::lock_guard lock(mutex_);
    const auto first = static_cast<std::size_t>(address);
    if (first + from.size() > to.size()) return ModbusException::kIllegalAddress;
    for (std::size_t i = 0; i < from.size(); ++i) to[first + i] = from[i];
    return ModbusException::kNone;
  }

  mutable std::mutex mutex_;
  Words registers_ = Words(100);  // this and all below: guarded by mutex_
  std::vector<std::uint8_t> coils_ = std::vector<std::uint8_t>(32);
  int writes_ = 0;
};

}  // namespace fvd::sim::test
