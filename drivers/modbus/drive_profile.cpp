#include "drivers/modbus/drive_profile.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/strict_json.hpp"
#include "core/error.hpp"

namespace fvd {

namespace {

using nlohmann::json;

/// Reads the parts of a profile whose keys are the profile's own: registers, conditions, sequences, alarms.
class ProfileReader {
 public:
  ProfileReader(const json& document, Problems& problems) : document_(document), problems_(problems) {}

  DriveProfile read() {
    read_plain_fields();
    read_registers();
    profile_.position = known_register("/feedback/register", text_at("/feedback", "register"));
    profile_.alarm_code = known_register("/alarm_register", text_at("", "alarm_register"));
    read_conditions();
    read_sequences();
    read_alarms();
    if (problems_.empty()) check_poll_block();
    return profile_;
  }

 private:
  /// Everything a plain description covers; the free-form parts are taken out first so that they are not unknown.
  void read_plain_fields() {
    json plain = document_;
    for (const char* part : {"registers", "status", "sequences", "alarms"}) {
      if (!document_.contains(part)) problems_.push_back({std::string("/") + part, "is missing and has no default"});
      plain.erase(part);
    }
    FieldReader reader(plain, problems_);
    describe(reader);
    reader.finish();
    profile_.direction = direction_ == "positive" ? 1 : -1;
    profile_.feedback = feedback_ == "motor_encoder"  ? FeedbackSource::kMotorEncoder
                        : feedback_ == "linear_scale" ? FeedbackSource::kLinearScale
                                                      : FeedbackSource::kNone;
    order_ = word_order_ == "low_first" ? WordOrder::kLowFirst : WordOrder::kHighFirst;
  }

  void describe(Fields& fields) {
    fields.text("name", profile_.name, 64, "of the drive family");
    fields.require("name");
    fields.text("vendor", profile_.vendor, 64, "maker");
    fields.text("manual", profile_.manual, 256, "where the register map stands");
    fields.choice("word_order", word_order_, {"high_first", "low_first"}, "order of the words of 32-bit registers");
    fields.text("alarm_register", alarm_register_, 64, "register of the alarm code");
    fields.require("alarm_register");
    fields.group("scale", "units of the drive", [this](Fields& scale) {
      scale.number("steps_per_um", profile_.steps_per_um, positive(1e6), "commanded steps per um");
      scale.choice("direction", direction_, {"positive", "negative"}, "sign of the steps when z grows");
      scale.number("speed_units_per_um_s", profile_.speed_units_per_um_s, positive(1e9), "register value per um/s");
      scale.number("acceleration_units_per_um_s2", profile_.acceleration_units_per_um_s2, positive(1e9),
                   "register value per um/s^2");
      scale.require("steps_per_um");
      scale.require("speed_units_per_um_s");
      scale.require("acceleration_units_per_um_s2");
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
    fields.group("poll", "one block that holds status and position", [this](Fields& poll) {
      poll.integer("address", profile_.poll_address, {0, 65535}, "PDU address");
      poll.integer("count", profile_.poll_count, {1, 125}, "registers");
      poll.require("address");
      poll.require("count");
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

  [[nodiscard]] std::string text_at(const char* group, const char* key) const {
    const auto pointer = json::json_pointer(std::string(group) + "/" + key);
    return document_.contains(pointer) && document_.at(pointer).is_string() ? document_.at(pointer).get<std::string>()
                                                                            : std::string();
  }

  void report(const std::string& pointer, const json& value, const std::string& expected) {
    problems_.push_back({pointer, value.dump() + " is not accepted; expected " + expected});
  }

  /// A whole number, also written as text "0x1A", which JSON has no other way to say.
  std::optional<std::int64_t> number(const std::string& pointer, const json& value, std::int64_t min,
                                     std::int64_t max) {
    std::optional<std::int64_t> result;
    if (value.is_number_integer()) {
      result = value.get<std::int64_t>();
    } else if (value.is_string() && value.get<std::string>().starts_with("0x")) {
      const auto text = value.get<std::string>();
      std::size_t used = 0;
      try {
        result = std::stoll(text, &used, 16);
      } catch (const std::exception&) {
        used = 0;
      }
      if (used != text.size()) result.reset();
    }
    if (!result || *result < min || *result > max) {
      report(pointer, value, "an integer or \"0x..\" within " + std::to_string(min) + ".." + std::to_string(max));
      return std::nullopt;
    }
    return result;
  }

  void refuse_other_keys(const std::string& pointer, const json& object, const std::set<std::string>& known) {
    for (const auto& [key, value] : object.items()) {
      if (!known.contains(key)) problems_.push_back({pointer + "/" + key, "unknown key"});
    }
  }

  /// The object at a top-level key; an empty one, with a problem, if it is of another type.
  const json& part(const char* key) {
    static const json kEmpty = json::object();
    const auto found = document_.find(key);
    if (found == document_.end()) return kEmpty;
    if (found->is_object()) return *found;
    report(std::string("/") + key, *found, "an object");
    return kEmpty;
  }

  void read_registers() {
    static const std::map<std::string, RegisterType> kTypes{{"u16", RegisterType::kU16},
                                                            {"i16", RegisterType::kI16},
                                                            {"u32", RegisterType::kU32},
                                                            {"i32", RegisterType::kI32}};
    for (const auto& [name, value] : part("registers").items()) {
      const std::string pointer = "/registers/" + name;
      if (!value.is_object() || !value.contains("address") || !value.contains("type")) {
        report(pointer, value, "an object with address and type");
        continue;
      }
      refuse_other_keys(pointer, value, {"address", "type"});
      DriveRegister reg;
      reg.order = order_;
      reg.address = static_cast<int>(number(pointer + "/address", value["address"], 0, 65535).value_or(0));
      const auto type = value["type"].is_string() ? kTypes.find(value["type"].get<std::string>()) : kTypes.end();
      if (type == kTypes.end()) {
        report(pointer + "/type", value["type"], "one of \"u16\", \"i16\", \"u32\", \"i32\"");
      } else {
        reg.type = type->second;
      }
      registers_[name] = reg;
    }
  }

  DriveRegister known_register(const std::string& pointer, const std::string& name) {
    const auto found = registers_.find(name);
    if (found != registers_.end()) return found->second;
    if (!name.empty()) problems_.push_back({pointer, "'" + name + "' is not one of the profile's registers"});
    return {};
  }

  void read_conditions() {
    const json& status = part("status");
    const std::map<std::string, StatusCondition*> wanted{{"enabled", &profile_.enabled},
                                                         {"homed", &profile_.homed},
                                                         {"moving", &profile_.moving},
                                                         {"in_position", &profile_.in_position},
                                                         {"alarm", &profile_.alarm}};
    for (const auto& [name, condition] : wanted) {
      const std::string pointer = "/status/" + name;
      if (!status.contains(name)) {
        problems_.push_back({pointer, "is missing and has no default"});
      } else {
        *condition = condition_from(pointer, status[name]);
      }
    }
    refuse_other_keys("/status", status, {"enabled", "homed", "moving", "in_position", "alarm"});
  }

  StatusCondition condition_from(const std::string& pointer, const json& value) {
    StatusCondition condition;
    if (!value.is_object() || !value.contains("register") || !value.contains("mask") ||
        !value["register"].is_string()) {
      report(pointer, value, "an object with register, mask and, if not all bits of the mask, equals");
      return condition;
    }
    refuse_other_keys(pointer, value, {"register", "mask", "equals"});
    condition.reg = known_register(pointer + "/register", value["register"].get<std::string>());
    condition.mask = static_cast<std::uint32_t>(number(pointer + "/mask", value["mask"], 1, 0xFFFFFFFF).value_or(1));
    condition.equals = condition.mask;
    if (value.contains("equals")) {
      condition.equals =
          static_cast<std::uint32_t>(number(pointer + "/equals", value["equals"], 0, 0xFFFFFFFF).value_or(0));
    }
    return condition;
  }

  void read_sequences() {
    const json& sequences = part("sequences");
    const std::map<std::string, DriveSequence*> wanted{{"enable", &profile_.enable},
                                                       {"home", &profile_.home},
                                                       {"move_absolute", &profile_.move_absolute},
                                                       {"stop", &profile_.stop},
                                                       {"alarm_reset", &profile_.alarm_reset}};
    for (const auto& [name, sequence] : wanted) {
      const std::string pointer = "/sequences/" + name;
      if (!sequences.contains(name) || !sequences[name].is_array()) {
        problems_.push_back({pointer, "is missing or not a list of frames"});
        continue;
      }
      for (std::size_t i = 0; i < sequences[name].size(); ++i) {
        read_frame(pointer + "/" + std::to_string(i), sequences[name][i], *sequence);
      }
    }
    refuse_other_keys("/sequences", sequences, {"enable", "home", "move_absolute", "stop", "alarm_reset"});
    for (const char* name : {"home", "move_absolute", "stop"}) {
      if (problems_.empty() && wanted.at(name)->empty()) {
        problems_.push_back({std::string("/sequences/") + name, "needs at least one frame"});
      }
    }
  }

  void read_frame(const std::string& pointer, const json& value, DriveSequence& sequence) {
    if (!value.is_object() || !value.contains("write") || !value["write"].is_array() || value["write"].empty()) {
      return report(pointer, value, "an object {\"write\": [[register, value], ...]}");
    }
    refuse_other_keys(pointer, value, {"write"});
    DriveFrame frame;
    for (std::size_t i = 0; i < value["write"].size(); ++i) {
      const std::string at = pointer + "/write/" + std::to_string(i);
      const json& pair = value["write"][i];
      if (!pair.is_array() || pair.size() != 2 || !pair[0].is_string()) {
        return report(at, pair, "[register, value]");
      }
      RegisterWrite write{known_register(at + "/0", pair[0].get<std::string>()), std::int64_t{0}};
      if (!frame.writes.empty()) {
        const DriveRegister& last = frame.writes.back().reg;
        if (write.reg.address != last.address + register_words(last.type)) {
          problems_.push_back({at, "registers of one frame must follow each other; start another frame"});
        }
      }
      write.value = value_of(at + "/1", pair[1]);
      frame.writes.push_back(write);
    }
    sequence.push_back(std::move(frame));
  }

  std::variant<std::int64_t, DriveVariable> value_of(const std::string& pointer, const json& value) {
    static const std::map<std::string, DriveVariable> kVariables{{"$target", DriveVariable::kTarget},
                                                                 {"$speed", DriveVariable::kSpeed},
                                                                 {"$acceleration", DriveVariable::kAcceleration}};
    if (value.is_string() && value.get<std::string>().starts_with("$")) {
      const auto found = kVariables.find(value.get<std::string>());
      if (found != kVariables.end()) return found->second;
      report(pointer, value, "one of \"$target\", \"$speed\", \"$acceleration\"");
      return std::int64_t{0};
    }
    return number(pointer, value, INT32_MIN, UINT32_MAX).value_or(0);
  }

  void read_alarms() {
    for (const auto& [code, text] : part("alarms").items()) {
      const std::string pointer = "/alarms/" + code;
      const auto value = number(pointer, json(code), 0, 0xFFFF);
      if (!text.is_string()) report(pointer, text, "a text");
      if (value && text.is_string()) profile_.alarms[static_cast<int>(*value)] = text.get<std::string>();
    }
  }

  void check_poll_block() {
    const auto inside = [this](const DriveRegister& reg) {
      return reg.address >= profile_.poll_address &&
             reg.address + register_words(reg.type) <= profile_.poll_address + profile_.poll_count;
    };
    const std::map<std::string, DriveRegister> wanted{
        {"/feedback/register", profile_.position}, {"/alarm_register", profile_.alarm_code},
        {"/status/enabled", profile_.enabled.reg}, {"/status/homed", profile_.homed.reg},
        {"/status/moving", profile_.moving.reg},   {"/status/in_position", profile_.in_position.reg},
        {"/status/alarm", profile_.alarm.reg}};
    for (const auto& [pointer, reg] : wanted) {
      if (!inside(reg)) {
        problems_.push_back({pointer, "its register at " + std::to_string(reg.address) + " is outside the poll block " +
                                          std::to_string(profile_.poll_address) + ".." +
                                          std::to_string(profile_.poll_address + profile_.poll_count - 1)});
      }
    }
  }

  const json& document_;
  Problems& problems_;
  DriveProfile profile_;
  std::map<std::string, DriveRegister> registers_;
  WordOrder order_ = WordOrder::kHighFirst;
  std::string word_order_ = "high_first";
  std::string direction_ = "positive";
  std::string feedback_ = "none";
  std::string feedback_register_;
  std::string alarm_register_;
};

}  // namespace

std::int64_t RegisterBlock::value(const DriveRegister& reg) const {
  const auto at = static_cast<std::size_t>(reg.address - address_);
  if (register_words(reg.type) == 1) {
    return reg.type == RegisterType::kI16 ? static_cast<std::int16_t>(words_[at]) : std::int64_t{words_[at]};
  }
  const std::uint32_t first = words_[at];
  const std::uint32_t second = words_[at + 1];
  const std::uint32_t bits = reg.order == WordOrder::kHighFirst ? (first << 16U) | second : (second << 16U) | first;
  return reg.type == RegisterType::kI32 ? static_cast<std::int32_t>(bits) : std::int64_t{bits};
}

std::vector<std::uint16_t> encode(const DriveRegister& reg, std::int64_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  const auto low = static_cast<std::uint16_t>(bits & 0xFFFFU);
  const auto high = static_cast<std::uint16_t>(bits >> 16U);
  if (register_words(reg.type) == 1) return {low};
  if (reg.order == WordOrder::kHighFirst) return {high, low};
  return {low, high};
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
