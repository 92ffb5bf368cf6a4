#pragma once

/// What fvd has to know of a drive, as data: registers, status, sequences, alarms. Read from config/drives/*.json,
/// whose fields config/drives/README.md lists.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/hw/axis.hpp"
#include "drivers/modbus/drive_register.hpp"
#include "drivers/modbus/drive_sequence.hpp"

namespace fvd {

/// From a physical value to a register's.
struct DriveUnit {
  double factor = 1.0;
  bool inverse = false;  ///< value = factor / physical: an acceleration given as a time
  std::int64_t min = 1;  ///< what the drive takes; values beyond are clamped
  std::int64_t max = 2147483647;

  [[nodiscard]] std::int64_t value(double physical) const;
};

struct DriveAlarm {
  std::string text;
  bool resettable = true;
  bool position_lost = false;  ///< home again after the reset
};

/// A register whose value says which drive this is.
struct DriveIdentity {
  DriveCondition condition;
  std::string text;  ///< what it is, for people
};

/// Stops the drive by itself when it hears nothing for a time.
struct DriveWatchdog {
  DriveRegister reg;
  std::int64_t armed = 0;     ///< register value
  std::int64_t disarmed = 0;  ///< register value
};

/// A number by which a single drive is known: its serial number, its firmware.
struct DriveLabel {
  std::string name;
  DriveRegister reg;
};

struct DriveTemperature {
  std::string name;
  DriveRegister reg;
  double celsius_per_unit = 0.1;
};

struct DriveSoftLimits {
  DriveRegister positive;  ///< in commanded steps
  DriveRegister negative;
};

struct DriveProfile {
  std::string name;
  std::string vendor;
  std::string manual;

  double steps_per_um = 1.0;   ///< commanded steps per um, > 0
  double counts_per_um = 1.0;  ///< feedback counts per um, > 0
  int direction = 1;           ///< +1 or -1: sign of steps when z grows
  double lead_um = 0.0;        ///< of the screw, period of its error; 0 unknown
  DriveUnit speed;             ///< physical: um/s
  DriveUnit acceleration;      ///< physical: um/s^2
  FeedbackSource feedback = FeedbackSource::kNone;
  double feedback_resolution_um = 0.0;

  std::vector<PollBlock> poll;  ///< read in this order; the one with the position last, so that status is not newer
  DriveRegister position;
  DriveRegister alarm_code;  ///< read on its own, in alarm, where no block holds it

  /// Reads the target of the last move; forgotten in a restart. For drives that do not say whether they are homed.
  std::optional<DriveRegister> target;

  std::vector<DriveRegister> watched;  ///< nobody but the drive's master writes them

  DriveCondition enabled;
  std::optional<DriveCondition> homed;  ///< nothing: the drive has no such bit; homed since the last homing then
  DriveCondition moving;
  DriveCondition in_position;
  DriveCondition alarm;
  std::optional<DriveCondition> limit_positive;
  std::optional<DriveCondition> limit_negative;
  std::optional<DriveCondition> emergency_stop;

  DriveSequence prepare;  ///< settings before the first motion; may be empty
  DriveSequence enable;   ///< run where `enabled` does not hold
  DriveSequence disable;  ///< may be empty
  DriveSequence home;
  DriveSequence move_absolute;
  DriveSequence stop;
  DriveSequence alarm_reset;

  std::vector<DriveIdentity> identify;
  std::optional<DriveWatchdog> watchdog;
  std::optional<DriveSoftLimits> soft_limits;
  std::vector<DriveTemperature> temperatures;
  std::vector<DriveLabel> labels;
  std::map<int, DriveAlarm> alarms;             ///< by code
  bool alarms_are_bits = false;                 ///< the codes are single bits, of which several may be set
  std::chrono::milliseconds start_within{150};  ///< a move that has not begun by then was refused
  std::chrono::milliseconds home_timeout{60000};
};

/// The alarms that a code stands for; empty if the profile knows none.
[[nodiscard]] std::vector<DriveAlarm> alarms_of(const DriveProfile& profile, int code);
/// "alarm 0x30: overload", "alarm 0x3: position error limit, counter-clockwise limit".
[[nodiscard]] std::string alarm_text(const DriveProfile& profile, int code);

/// Throws Error kBadConfig with every problem, each with its JSON pointer, value and accepted range.
[[nodiscard]] DriveProfile parse_drive_profile(std::string_view json_text, const std::string& source);
/// Throws likewise, or kBadInput if the file cannot be read.
[[nodiscard]] DriveProfile load_drive_profile(const std::filesystem::path& file);

/// JSON Schema of a profile; config/drive.schema.json is this text.
[[nodiscard]] std::string drive_profile_schema_text();

}  // namespace fvd
