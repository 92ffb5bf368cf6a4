#pragma once

/// What fvd has to know of a drive, as data: registers, status bits, sequences, alarms. Read from config/drives/*.json.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/hw/z_stage.hpp"

namespace fvd {

enum class RegisterType { kU16, kI16, kU32, kI32 };
[[nodiscard]] constexpr int register_words(RegisterType type) {
  return type == RegisterType::kU16 || type == RegisterType::kI16 ? 1 : 2;
}

enum class WordOrder { kHighFirst, kLowFirst };

/// A holding register, or a pair of them.
struct DriveRegister {
  int address = 0;  ///< PDU address, 0..65535
  RegisterType type = RegisterType::kU16;
  WordOrder order = WordOrder::kHighFirst;
};

/// A contiguous block read in one transaction: one coherent sample of the drive.
class RegisterBlock {
 public:
  RegisterBlock() = default;
  RegisterBlock(int address, std::vector<std::uint16_t> words) : address_(address), words_(std::move(words)) {}
  /// The register's value; it lies inside the block (checked when the profile is read).
  [[nodiscard]] std::int64_t value(const DriveRegister& reg) const;

 private:
  int address_ = 0;
  std::vector<std::uint16_t> words_;
};

/// The words of a value as they stand on the wire.
[[nodiscard]] std::vector<std::uint16_t> encode(const DriveRegister& reg, std::int64_t value);

/// (register & mask) == equals.
struct StatusCondition {
  DriveRegister reg;
  std::uint32_t mask = 0;
  std::uint32_t equals = 0;

  [[nodiscard]] bool holds(const RegisterBlock& block) const {
    return (static_cast<std::uint32_t>(block.value(reg)) & mask) == equals;
  }
};

/// What a sequence may put in place of a number.
enum class DriveVariable { kTarget, kSpeed, kAcceleration };

struct RegisterWrite {
  DriveRegister reg;
  std::variant<std::int64_t, DriveVariable> value;
};

/// Registers that follow each other, written in one frame.
struct DriveFrame {
  std::vector<RegisterWrite> writes;

  [[nodiscard]] int address() const { return writes.front().reg.address; }
};
using DriveSequence = std::vector<DriveFrame>;

struct DriveProfile {
  std::string name;
  std::string vendor;
  std::string manual;

  double steps_per_um = 1.0;          ///< commanded steps per um, > 0
  double counts_per_um = 1.0;         ///< feedback counts per um, > 0
  int direction = 1;                  ///< +1 or -1: sign of steps when z grows
  double speed_units_per_um_s = 1.0;  ///< register value per um/s
  double acceleration_units_per_um_s2 = 1.0;
  FeedbackSource feedback = FeedbackSource::kNone;
  double feedback_resolution_um = 0.0;

  int poll_address = 0;  ///< one block that holds all status registers and the position
  int poll_count = 1;    ///< 1..125
  DriveRegister position;
  DriveRegister alarm_code;

  StatusCondition enabled;
  StatusCondition homed;
  StatusCondition moving;
  StatusCondition in_position;
  StatusCondition alarm;

  DriveSequence enable;
  DriveSequence home;
  DriveSequence move_absolute;
  DriveSequence stop;
  DriveSequence alarm_reset;

  std::map<int, std::string> alarms;            ///< code -> text
  std::chrono::milliseconds start_within{150};  ///< a move that has not begun by then was refused
  std::chrono::milliseconds home_timeout{60000};
};

/// Throws Error kBadConfig with every problem, each with its JSON pointer, value and accepted range.
[[nodiscard]] DriveProfile parse_drive_profile(std::string_view json_text, const std::string& source);
/// Throws likewise, or kBadInput if the file cannot be read.
[[nodiscard]] DriveProfile load_drive_profile(const std::filesystem::path& file);

}  // namespace fvd
