#pragma once

/// A drive's registers: where they stand, how their words make a number, and what conditions say about them.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/modbus/modbus_link.hpp"

namespace fvd {

enum class RegisterType { kBit, kU16, kI16, kU32, kI32 };
enum class WordOrder { kHighFirst, kLowFirst };
/// kBase1000: of two words the upper holds thousands, the lower 0..999 with the same sign (AMCI SMD23E2).
enum class RegisterCodec { kPlain, kBase1000 };

struct DriveRegister {
  std::string name{};
  int address = 0;  ///< PDU address, 0..65535
  RegisterType type = RegisterType::kU16;
  WordOrder order = WordOrder::kHighFirst;
  RegisterCodec codec = RegisterCodec::kPlain;
  ModbusTable table = ModbusTable::kHolding;
  bool write_single = false;  ///< one word goes by FC 6, for drives that know no FC 16 there
  bool readable = true;       ///< false: a command register; it cannot be polled, expected or changed bit by bit

  [[nodiscard]] int words() const noexcept { return type == RegisterType::kU32 || type == RegisterType::kI32 ? 2 : 1; }
};

/// Whether the register can hold the value.
[[nodiscard]] bool holds(const DriveRegister& reg, std::int64_t value) noexcept;
/// The register's words, or its bit, as they stand on the wire. A value for which holds() is false is cut to
/// its low words: ask before.
[[nodiscard]] std::vector<std::uint16_t> encode(const DriveRegister& reg, std::int64_t value);
/// words: reg.words() of them.
[[nodiscard]] std::int64_t decode(const DriveRegister& reg, const std::uint16_t* words);

/// A contiguous block that is read in one transaction.
struct PollBlock {
  ModbusTable table = ModbusTable::kHolding;
  int address = 0;  ///< PDU address
  int count = 1;    ///< 1..125 registers

  [[nodiscard]] bool holds(const DriveRegister& reg) const noexcept {
    return reg.table == table && reg.address >= address && reg.address + reg.words() <= address + count;
  }
};

/// What the blocks of one poll said.
class RegisterImage {
 public:
  void add(const PollBlock& block, std::vector<std::uint16_t> words);
  /// Nothing where no block holds the register.
  [[nodiscard]] std::optional<std::int64_t> value(const DriveRegister& reg) const;

 private:
  struct Part {
    PollBlock block;
    std::vector<std::uint16_t> words;
  };
  std::vector<Part> parts_;
};

/// A statement about registers: (value & mask) == or != a number, or a combination of such.
class DriveCondition {
 public:
  enum class Kind { kEquals, kDiffers, kNot, kAll, kAny };
  /// How a register is looked up; nothing if it could not be read.
  using Lookup = std::function<std::optional<std::int64_t>(const DriveRegister&)>;

  [[nodiscard]] static DriveCondition compare(DriveRegister reg, std::uint32_t mask, std::uint32_t number, bool equals);
  [[nodiscard]] static DriveCondition combine(Kind kind, std::vector<DriveCondition> parts);

  /// Nothing if a register that matters could not be read.
  [[nodiscard]] std::optional<bool> holds(const Lookup& lookup) const;
  /// Every register the condition looks at.
  [[nodiscard]] std::vector<DriveRegister> registers() const;

 private:
  Kind kind_ = Kind::kAll;
  DriveRegister reg_;
  std::uint32_t mask_ = 0;
  std::uint32_t number_ = 0;
  std::vector<DriveCondition> parts_;  // of an empty "all" holds is true
};

}  // namespace fvd
