#include "drivers/modbus/drive_profile.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "drivers/modbus/drive_profile_parts.hpp"

namespace fvd {

namespace {

using nlohmann::json;

constexpr IntegerRange kRegisterValue{0, 2147483647};

class ProfileReader {
 public:
  ProfileReader(const json& document, Problems& problems)
      : document_(document), problems_(problems), parts_(problems) {}

  DriveProfile read() {
    read_plain_fields();
    parts_.read_registers(object("registers"), order_);
    profile_.position = named_register("/feedback", "register");
    profile_.alarm_code = named_register("", "alarm_register");
    if (!target_register_.empty()) profile_.target = named_register("", "target_register");
    read_poll();
    read_status();
    read_sequences();
    read_alarms();
    read_identity();
    read_extras();
    if (problems_.empty()) check_poll_blocks();
    return std::move(profile_);
  }

 private:
  /// Everything a plain description covers; the free-form parts are taken out first so that they are not unknown.
  void read_plain_fields() {
    json plain = document_;
    for (const char* part : {"registers", "status", "sequences", "alarms", "poll"}) {
      if (!document_.contains(part)) problems_.push_back({std::string("/") + part, "is missing and has no default"});
      plain.erase(part);
    }
    for (const char* part : {"identify", "watchdog", "soft_limits", "temperatures"}) plain.erase(part);
    FieldReader reader(plain, problems_);
    describe(reader);
    reader.finish();
    profile_.direction = direction_ == "positive" ? 1 : -1;
    profile_.feedback = feedback_ == "motor_encoder"  ? FeedbackSource::kMotorEncoder
                        : feedback_ == "linear_scale" ? FeedbackSource::kLinearScale
                                                      : FeedbackSource::kNone;
    order_ = word_order_ == "low_first" ? WordOrder::kLowFirst : WordOrder::kHighFirst;
    if (acceleration_inverse_ > 0.0) {
      profile_.acceleration.factor = acceleration_inverse_;
      profile_.acceleration.inverse = true;
    } else if (document_.contains("/scale"_json_pointer) &&
               !document_.contains("/scale/acceleration_units_per_um_s2"_json_pointer)) {
      problems_.push_back({"/scale/acceleration_units_per_um_s2",
                           "is missing and has no default; or give acceleration_inverse_um_s2 for a time"});
    }
  }

  void describe(Fields& fields) {
    fields.text("name", profile_.name, 64, "of the drive family");
    fields.require("name");
    fields.text("vendor", profile_.vendor, 64, "maker");
    fields.text("manual", profile_.manual, 256, "where the register map stands");
    fields.choice("word_order", word_order_, {"high_first", "low_first"}, "order of the words of 32-bit registers");
    fields.text("alarm_register", alarm_register_, 64, "register of the alarm code");
    fields.require("alarm_register");
    fields.text("target_register", target_register_, 64,
                "reads back the last target; needed where homed is remembered");
    fields.group("scale", "units of the drive", [this](Fields& scale) {
      scale.number("steps_per_um", profile_.steps_per_um, positive(1e6), "commanded steps per um");
      scale.choice("direction", direction_, {"positive", "negative"}, "sign of the steps when z grows");
      scale.number("lead_um", profile_.lead_um, {0.0, 1e6}, "screw lead, the period of its error; 0 = unknown");
      scale.number("speed_units_per_um_s", profile_.speed.factor, positive(1e9), "register value per um/s");
      scale.integer("speed_min", profile_.speed.min, kRegisterValue, "smallest register value the drive takes");
      scale.integer("speed_max", profile_.speed.max, kRegisterValue, "largest");
      scale.number("acceleration_units_per_um_s2", profile_.acceleration.factor, positive(1e9),
                   "register value per um/s^2");
      scale.number("acceleration_inverse_um_s2", acceleration_inverse_, {0.0, 1e15},
                   "register value times um/s^2, for drives that take a time");
      scale.integer("acceleration_min", profile_.acceleration.min, kRegisterValue, "smallest register value");
      scale.integer("acceleration_max", profile_.acceleration.max, kRegisterValue, "largest");
      scale.require("steps_per_um");
      scale.require("speed_units_per_um_s");
    });
    fields.group("feedback", "where the measured position comes from", [this](Fields& feedback) {
      feedback.choice("source", feedback_, {"none", "motor_encoder", "linear_scale"}, "none = not observable");
      feedback.text("register", feedback_register_, 64, "register of the position");
      feedback.number("counts_per_um", profile_.counts_per_um, positive(1e6), "counts per um");
      feedback.number("resolution_um", profile_.feedback_resolution_um, {0.0, 1000.0}, "smallest step of the reading");
      feedback.require("source");
      feedback.require("register");
      feedback.require("counts_per_um");
    });
    fields.group("timing", "how long the drive may take", [this](Fields& timing) {
      auto start_ms = profile_.start_within.count();
      auto home_ms = profile_.home_timeout.count();
      timing.integer("start_within_ms", start_ms, {1, 10000}, "a move not begun by then was refused");
      timing.integer("home_timeout_ms", home_ms, {100, 600000}, "for the whole homing");
      profile_.start_within = std::chrono::milliseconds(start_ms);
      profile_.home_timeout = std::chrono::milliseconds(home_ms);
    });
  }

  /// The object at a top-level key; an empty one, with a problem, if it is of another type.
  const json& object(const char* key) {
    static const json kEmpty = json::object();
    const auto found = document_.find(key);
    if (found == document_.end()) return kEmpty;
    if (found->is_object()) return *found;
    parts_.report(std::string("/") + key, *found, "an object");
    return kEmpty;
  }

  /// Likewise a list.
  const json& list(const char* key) {
    static const json kEmpty = json::array();
    const auto found = document_.find(key);
    if (found == document_.end()) return kEmpty;
    if (found->is_array()) return *found;
    parts_.report(std::string("/") + key, *found, "a list");
    return kEmpty;
  }

  DriveRegister named_register(const std::string& group, const char* key) {
    const auto pointer = json::json_pointer(group + "/" + key);
    if (!document_.contains(pointer)) return {};  // reported as missing already
    return parts_.known_register(pointer.to_string(), document_.at(pointer), true);
  }

  void read_poll() {
    const json& blocks = list("poll");
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const std::string pointer = "/poll/" + std::to_string(i);
      const json& value = blocks[i];
      if (!value.is_object() || !value.contains("address") || !value.contains("count")) {
        parts_.report(pointer, value, "an object with address, count and, if not holding, table");
        continue;
      }
      parts_.refuse_other_keys(pointer, value, {"address", "count", "table"});
      PollBlock block;
      block.address = static_cast<int>(parts_.number(pointer + "/address", value["address"], 0, 65535).value_or(0));
      block.count = static_cast<int>(parts_.number(pointer + "/count", value["count"], 1, 125).value_or(1));
      if (value.contains("table")) {
        if (value["table"] == "input") {
          block.table = ModbusTable::kInput;
        } else if (value["table"] != "holding") {
          parts_.report(pointer + "/table", value["table"], "\"holding\" or \"input\"");
        }
      }
      profile_.poll.push_back(block);
    }
    if (document_.contains("poll") && blocks.empty()) parts_.report("/poll", blocks, "at least one block");
  }

  void read_status() {
    const json& status = object("status");
    const std::map<std::string, DriveCondition*> wanted{{"enabled", &profile_.enabled},
                                                        {"moving", &profile_.moving},
                                                        {"in_position", &profile_.in_position},
                                                        {"alarm", &profile_.alarm}};
    for (const auto& [name, condition] : wanted) {
      const std::string pointer = "/status/" + name;
      if (!status.contains(name)) {
        problems_.push_back({pointer, "is missing and has no default"});
      } else {
        *condition = parts_.condition(pointer, status[name]);
      }
    }
    if (!status.contains("homed")) {
      problems_.push_back({"/status/homed", "is missing and has no default; \"remembered\" = since the last homing"});
    } else if (status["homed"] != "remembered") {
      profile_.homed = parts_.condition("/status/homed", status["homed"]);
    } else if (!profile_.target) {
      problems_.push_back({"/target_register", "is missing: without a bit for homed it tells a restart of the drive"});
    }
    const std::map<std::string, std::optional<DriveCondition>*> known{{"limit_positive", &profile_.limit_positive},
                                                                      {"limit_negative", &profile_.limit_negative},
                                                                      {"emergency_stop", &profile_.emergency_stop}};
    for (const auto& [name, condition] : known) {
      if (status.contains(name)) *condition = parts_.condition("/status/" + name, status[name]);
    }
    parts_.refuse_other_keys(
        "/status", status,
        {"enabled", "homed", "moving", "in_position", "alarm", "limit_positive", "limit_negative", "emergency_stop"});
  }

  void read_sequences() {
    const json& sequences = object("sequences");
    const std::map<std::string, DriveSequence*> wanted{{"enable", &profile_.enable},
                                                       {"home", &profile_.home},
                                                       {"move_absolute", &profile_.move_absolute},
                                                       {"stop", &profile_.stop},
                                                       {"alarm_reset", &profile_.alarm_reset}};
    for (const auto& [name, sequence] : wanted) {
      const std::string pointer = "/sequences/" + name;
      if (!sequences.contains(name)) {
        problems_.push_back({pointer, "is missing and has no default; [] = nothing to do"});
        continue;
      }
      *sequence = parts_.sequence(pointer, sequences[name]);
    }
    if (sequences.contains("disable")) {
      profile_.disable = parts_.sequence("/sequences/disable", sequences["disable"]);
    }
    parts_.refuse_other_keys("/sequences", sequences,
                             {"enable", "disable", "home", "move_absolute", "stop", "alarm_reset"});
    for (const char* name : {"home", "move_absolute", "stop"}) {
      if (problems_.empty() && wanted.at(name)->empty()) {
        problems_.push_back({std::string("/sequences/") + name, "needs at least one step"});
      }
    }
  }

  void read_alarms() {
    for (const auto& [code, value] : object("alarms").items()) {
      const std::string pointer = "/alarms/" + code;
      const auto number = parts_.number(pointer, json(code), 0, 0x7FFFFFFF);
      DriveAlarm alarm;
      if (value.is_string()) {
        alarm.text = value.get<std::string>();
      } else if (value.is_object() && value.contains("text") && value["text"].is_string()) {
        alarm.text = value["text"].get<std::string>();
        parts_.refuse_other_keys(pointer, value, {"text", "resettable", "position_lost"});
        for (const auto& [key, flag] :
             {std::pair{"resettable", &alarm.resettable}, {"position_lost", &alarm.position_lost}}) {
          if (!value.contains(key)) continue;
          if (value[key].is_boolean()) {
            *flag = value[key].get<bool>();
          } else {
            parts_.report(pointer + "/" + key, value[key], "true or false");
          }
        }
      } else {
        parts_.report(pointer, value, "a text, or an object with text, resettable and position_lost");
      }
      if (number) profile_.alarms[static_cast<int>(*number)] = alarm;
    }
  }

  void read_identity() {
    const json& entries = list("identify");
    for (std::size_t i = 0; i < entries.size(); ++i) {
      json condition = entries[i];
      const std::string pointer = "/identify/" + std::to_string(i);
      DriveIdentity identity;
      if (condition.is_object() && condition.contains("text") && condition["text"].is_string()) {
        identity.text = condition["text"].get<std::string>();
        condition.erase("text");
      } else {
        problems_.push_back({pointer + "/text", "is missing: what this register says, for people"});
      }
      identity.condition = parts_.condition(pointer, condition);
      profile_.identify.push_back(std::move(identity));
    }
  }

  void read_extras() {
    if (document_.contains("watchdog")) {
      const json& value = object("watchdog");
      parts_.refuse_other_keys("/watchdog", value, {"register", "armed", "disarmed"});
      DriveWatchdog watchdog;
      watchdog.reg = member_register("/watchdog", value, "register");
      watchdog.armed = member_number("/watchdog", value, "armed");
      watchdog.disarmed = member_number("/watchdog", value, "disarmed");
      profile_.watchdog = watchdog;
    }
    if (document_.contains("soft_limits")) {
      const json& value = object("soft_limits");
      parts_.refuse_other_keys("/soft_limits", value, {"positive", "negative"});
      profile_.soft_limits = {member_register("/soft_limits", value, "positive"),
                              member_register("/soft_limits", value, "negative")};
    }
    if (!document_.contains("temperatures")) return;
    for (const auto& [name, value] : object("temperatures").items()) {
      const std::string pointer = "/temperatures/" + name;
      parts_.refuse_other_keys(pointer, value, {"register", "celsius_per_unit"});
      DriveTemperature temperature;
      temperature.name = name;
      temperature.reg = member_register(pointer, value, "register");
      if (value.is_object() && value.contains("celsius_per_unit")) {
        if (value["celsius_per_unit"].is_number()) {
          temperature.celsius_per_unit = value["celsius_per_unit"].get<double>();
        } else {
          parts_.report(pointer + "/celsius_per_unit", value["celsius_per_unit"], "a number");
        }
      }
      profile_.temperatures.push_back(std::move(temperature));
    }
  }

  DriveRegister member_register(const std::string& pointer, const json& value, const char* key) {
    if (!value.is_object() || !value.contains(key)) {
      problems_.push_back({pointer + "/" + key, "is missing and has no default"});
      return {};
    }
    return parts_.known_register(pointer + "/" + key, value[key], true);
  }

  std::int64_t member_number(const std::string& pointer, const json& value, const char* key) {
    if (!value.is_object() || !value.contains(key)) {
      problems_.push_back({pointer + "/" + key, "is missing and has no default"});
      return 0;
    }
    return parts_.number(pointer + "/" + key, value[key], 0, UINT32_MAX).value_or(0);
  }

  /// What is looked at in every sample stands in the blocks that are read for it.
  void check_poll_blocks() {
    const auto polled = [this](const std::string& pointer, const DriveRegister& reg) {
      const bool inside =
          std::any_of(profile_.poll.begin(), profile_.poll.end(), [&](const PollBlock& b) { return b.holds(reg); });
      if (inside) return;
      problems_.push_back({pointer, "its register '" + reg.name + "' at " + std::to_string(reg.address) +
                                        " is in none of the blocks of /poll"});
    };
    polled("/feedback/register", profile_.position);
    for (const auto& [name, condition] : {std::pair{"enabled", &profile_.enabled},
                                          {"moving", &profile_.moving},
                                          {"in_position", &profile_.in_position},
                                          {"alarm", &profile_.alarm}}) {
      for (const DriveRegister& reg : condition->registers()) polled(std::string("/status/") + name, reg);
    }
    for (const auto* condition :
         {&profile_.homed, &profile_.limit_positive, &profile_.limit_negative, &profile_.emergency_stop}) {
      if (!*condition) continue;
      for (const DriveRegister& reg : (*condition)->registers()) polled("/status", reg);
    }
    if (problems_.empty() && !profile_.poll.back().holds(profile_.position)) {
      problems_.push_back({"/poll", "the last block must hold the position, so that no status is newer than it"});
    }
  }

  const json& document_;
  Problems& problems_;
  ProfileParts parts_;
  DriveProfile profile_;
  WordOrder order_ = WordOrder::kHighFirst;
  std::string word_order_ = "high_first";
  std::string direction_ = "positive";
  std::string feedback_ = "none";
  std::string feedback_register_;
  std::string alarm_register_;
  std::string target_register_;
  double acceleration_inverse_ = 0.0;
};

}  // namespace

std::int64_t DriveUnit::value(double physical) const {
  const double exact = inverse ? factor / physical : factor * physical;
  return std::clamp(static_cast<std::int64_t>(std::clamp(std::round(exact), -9e15, 9e15)), min, max);
}

std::string alarm_text(const DriveProfile& profile, int code) {
  std::ostringstream text;
  text << "alarm 0x" << std::hex << std::uppercase << code;
  const auto known = profile.alarms.find(code);
  if (known == profile.alarms.end()) return text.str() + ": see the drive's manual";
  text << ": " << known->second.text;
  if (!known->second.resettable) text << " (not resettable: switch the drive off and on)";
  if (known->second.position_lost) text << " (position lost: home again)";
  return text.str();
}

DriveProfile parse_drive_profile(std::string_view json_text, const std::string& source) {
  Problems problems;
  DriveProfile profile;
  if (const auto document = parse_strict_json(json_text, problems)) {
    if (document->is_object()) {
      profile = ProfileReader(*document, problems).read();
    } else {
      problems.push_back({"", "a drive profile is an object"});
    }
  }
  throw_if_any(problems, ErrorCode::kBadConfig, source);
  return profile;
}

DriveProfile load_drive_profile(const std::filesystem::path& file) {
  return parse_drive_profile(read_text_file(file), file.string());
}

}  // namespace fvd
