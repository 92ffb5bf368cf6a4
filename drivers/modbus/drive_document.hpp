#pragma once

/// A drive profile as it is written: registers by their names, conditions and steps as nested objects. Its description
/// reads it, writes it and makes its schema; build_drive_profile() turns it into what the driver runs on.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/fields.hpp"
#include "config/problem.hpp"
#include "drivers/modbus/drive_profile.hpp"

namespace fvd {

/// Texts of choices stand as in the file; those of registers are names.
struct RegisterDocument {
  std::int64_t address = 0;
  std::string type = "u16";
  std::string table = "holding";
  std::string codec = "plain";
  std::optional<std::string> word_order;  ///< absent: the profile's
  std::optional<std::int64_t> write_function;
  std::string access = "read_write";
};

struct ConditionDocument {
  std::string kind = "register";  ///< register, not, all, any
  std::string reg;
  std::optional<std::int64_t> mask;
  std::optional<std::int64_t> equals;
  std::optional<std::int64_t> differs;
  std::vector<ConditionDocument> parts;  ///< of not: one
};

struct ValueDocument {
  std::string reg;
  std::string variable;  ///< "$target", "$speed", "$acceleration", or empty: number counts
  std::int64_t number = 0;
};

struct StepDocument {
  std::string kind;  ///< write, pulse, modify, wait, delay_ms, expect, if
  std::vector<ValueDocument> values;
  bool repeatable = false;
  std::string reg;
  std::optional<std::int64_t> mask;
  std::int64_t set = 0;
  std::int64_t clear = 0;
  std::int64_t on_ms = 0;
  std::int64_t off_ms = 0;
  std::int64_t delay_ms = 0;
  std::int64_t timeout_ms = 0;
  ConditionDocument condition;
  std::vector<StepDocument> then;
  std::vector<StepDocument> otherwise;
};

struct AlarmDocument {
  std::string words;  ///< the text alone, or empty and the alarm counts
  DriveAlarm alarm;
};

struct IdentityDocument {
  std::string text;
  ConditionDocument condition;
};

struct WatchedDocument {
  std::string reg;
};

struct WatchdogDocument {
  std::string reg;
  std::int64_t armed = 0;
  std::int64_t disarmed = 0;
};

struct SoftLimitsDocument {
  std::string positive;
  std::string negative;
};

struct TemperatureDocument {
  std::string reg;
  double celsius_per_unit = 0.1;
};

struct LabelDocument {
  std::string reg;
};

struct DriveDocument {
  DriveProfile plain;  ///< its values that need no registers: names, scale, timing, poll
  std::string word_order = "high_first";
  std::string alarm_register;
  std::optional<std::string> target_register;
  std::string direction = "positive";
  std::optional<double> acceleration_units_per_um_s2;
  double acceleration_inverse_um_s2 = 0.0;  ///< 0 = the drive takes no time
  std::string feedback_source = "none";
  std::string feedback_register;

  std::map<std::string, RegisterDocument> registers;
  ConditionDocument enabled;
  std::string homed_word;  ///< "remembered", or empty and homed counts
  ConditionDocument homed;
  ConditionDocument moving;
  ConditionDocument in_position;
  ConditionDocument alarm;
  std::optional<ConditionDocument> limit_positive;
  std::optional<ConditionDocument> limit_negative;
  std::optional<ConditionDocument> emergency_stop;

  std::vector<StepDocument> prepare;
  std::vector<StepDocument> enable;
  std::vector<StepDocument> disable;
  std::vector<StepDocument> home;
  std::vector<StepDocument> move_absolute;
  std::vector<StepDocument> stop;
  std::vector<StepDocument> alarm_reset;

  std::map<std::string, AlarmDocument> alarms;
  std::vector<IdentityDocument> identify;
  std::vector<WatchedDocument> watch;
  std::optional<WatchdogDocument> watchdog;
  std::optional<SoftLimitsDocument> soft_limits;
  std::map<std::string, TemperatureDocument> temperatures;
  std::map<std::string, LabelDocument> labels;
};

/// Every key with its range and meaning: the one place that defines them.
void describe(DriveDocument& document, Fields& fields);

/// Puts registers in place of their names and checks what keys say together. problems: those of the document so far;
/// those found are added, with their pointers. With any, the result is of no use.
[[nodiscard]] DriveProfile build_drive_profile(const DriveDocument& document, Problems& problems);

}  // namespace fvd
