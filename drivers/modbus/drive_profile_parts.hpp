#pragma once

/// The parts of a drive profile whose keys are the profile's own: registers, conditions and the steps of sequences.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "config/problem.hpp"
#include "drivers/modbus/drive_register.hpp"
#include "drivers/modbus/drive_sequence.hpp"

namespace fvd {

/// Reports every problem with its JSON pointer and reads on with something harmless. context: one thread.
class ProfileParts {
 public:
  explicit ProfileParts(Problems& problems) : problems_(problems) {}

  /// First of all; order: of registers that say nothing of their own.
  void read_registers(const nlohmann::json& registers, WordOrder order);

  /// A register by its name; reports a name that is unknown, or not readable where it must be read.
  DriveRegister known_register(const std::string& pointer, const nlohmann::json& name, bool to_read);
  DriveCondition condition(const std::string& pointer, const nlohmann::json& value);
  DriveSequence sequence(const std::string& pointer, const nlohmann::json& value);

  /// A whole number, also written as text "0x1A", which JSON has no other way to say.
  std::optional<std::int64_t> number(const std::string& pointer, const nlohmann::json& value, std::int64_t min,
                                     std::int64_t max);
  void refuse_other_keys(const std::string& pointer, const nlohmann::json& object, const std::set<std::string>& known);
  void report(const std::string& pointer, const nlohmann::json& value, const std::string& expected);

 private:
  DriveRegister read_register(const std::string& pointer, const nlohmann::json& value, WordOrder order);
  std::optional<DriveStep> step(const std::string& pointer, const nlohmann::json& value);
  std::vector<RegisterWrite> values(const std::string& pointer, const nlohmann::json& list, bool contiguous);
  DriveValue value_of(const std::string& pointer, const nlohmann::json& value);
  std::uint32_t bits(const std::string& pointer, const nlohmann::json& object, const char* key,
                     std::uint32_t otherwise);
  std::chrono::milliseconds time(const std::string& pointer, const nlohmann::json& object, const char* key);

  Problems& problems_;
  std::map<std::string, DriveRegister> registers_;
};

}  // namespace fvd
