/// From names of registers to registers, and what the keys of a drive profile must say together.

#include <algorithm>
#include <charconv>

#include "drivers/modbus/drive_document.hpp"

namespace fvd {

namespace {

class ProfileBuilder {
 public:
  ProfileBuilder(const DriveDocument& document, Problems& problems)
      : document_(document), problems_(problems), profile_(document.plain) {}

  DriveProfile build() {
    build_scale();
    build_registers();
    profile_.position = reg("/feedback/register", document_.feedback_register, true);
    profile_.alarm_code = reg("/alarm_register", document_.alarm_register, true);
    if (document_.target_register) profile_.target = reg("/target_register", *document_.target_register, true);
    build_status();
    build_sequences();
    build_alarms();
    build_extras();
    if (problems_.empty()) check_poll_blocks();
    return std::move(profile_);
  }

 private:
  void report(const std::string& pointer, std::string message) { problems_.push_back({pointer, std::move(message)}); }

  void build_scale() {
    profile_.direction = document_.direction == "positive" ? 1 : -1;
    profile_.feedback = document_.feedback_source == "motor_encoder"  ? FeedbackSource::kMotorEncoder
                        : document_.feedback_source == "linear_scale" ? FeedbackSource::kLinearScale
                                                                      : FeedbackSource::kNone;
    const std::string key = "/scale/acceleration_units_per_um_s2";
    if (document_.acceleration_inverse_um_s2 > 0.0) {
      profile_.acceleration.factor = document_.acceleration_inverse_um_s2;
      profile_.acceleration.inverse = true;
    } else if (document_.acceleration_units_per_um_s2) {
      profile_.acceleration.factor = *document_.acceleration_units_per_um_s2;
    } else if (!is_reported(problems_, key)) {
      report(key, "is missing and has no default; or give acceleration_inverse_um_s2 for a time");
    }
  }

  void build_registers() {
    for (const auto& [name, text] : document_.registers) {
      const std::string pointer = "/registers/" + name;
      DriveRegister one;
      one.name = name;
      one.address = static_cast<int>(text.address);
      one.type = text.type == "bit"   ? RegisterType::kBit
                 : text.type == "i16" ? RegisterType::kI16
                 : text.type == "u32" ? RegisterType::kU32
                 : text.type == "i32" ? RegisterType::kI32
                                      : RegisterType::kU16;
      one.table = text.table == "input"      ? ModbusTable::kInput
                  : text.table == "coil"     ? ModbusTable::kCoil
                  : text.table == "discrete" ? ModbusTable::kDiscrete
                                             : ModbusTable::kHolding;
      one.codec = text.codec == "base1000" ? RegisterCodec::kBase1000 : RegisterCodec::kPlain;
      const bool low_first = text.word_order.value_or(document_.word_order) == "low_first";
      one.order = low_first ? WordOrder::kLowFirst : WordOrder::kHighFirst;
      one.readable = text.access == "read_write";
      if (text.write_function) {
        const std::int64_t function = *text.write_function;
        one.write_single = function == 5 || function == 6;
        if (!one.write_single && function != 15 && function != 16) {
          report(pointer + "/write_function",
                 std::to_string(function) + " is not accepted; expected 5 or 15 for coils, 6 or 16 for registers");
        }
      }
      const bool bit_table = one.table == ModbusTable::kCoil || one.table == ModbusTable::kDiscrete;
      if (bit_table != (one.type == RegisterType::kBit)) {
        report(pointer, "type \"bit\" belongs to the tables coil and discrete, all others to registers");
      }
      if (one.codec == RegisterCodec::kBase1000 && one.words() != 2) {
        report(pointer + "/codec", "base1000 needs two words: type u32 or i32");
      }
      registers_[name] = std::move(one);
    }
  }

  DriveRegister reg(const std::string& pointer, const std::string& name, bool to_read) {
    // Where the registers could not be read, or no name stands in the document, that was said.
    const bool unread = registers_.empty() && !problems_.empty();
    if (unread || (name.empty() && !problems_.empty())) return {};
    const auto found = registers_.find(name);
    if (found == registers_.end()) {
      report(pointer, "'" + name + "' is not one of the profile's registers; expected one of /registers");
      return {};
    }
    if (to_read && !found->second.readable) {
      report(pointer, "'" + name + "' can only be written, says its \"access\"; expected a register that can be read");
    }
    return found->second;
  }

  void require_fits(const std::string& pointer, const DriveRegister& reg, std::int64_t value) {
    if (reg.name.empty() || holds(reg, value)) return;  // what is wrong with a register without a name was said
    report(pointer, std::to_string(value) + " does not fit into '" + reg.name + "'");
  }

  DriveCondition condition(const std::string& pointer, const ConditionDocument& text) {
    if (text.kind != "register") {
      const std::string all = pointer + "/" + text.kind;
      std::vector<DriveCondition> parts;
      for (std::size_t i = 0; i < text.parts.size(); ++i) {
        std::string part = all;
        if (text.kind != "not") part.append("/").append(std::to_string(i));
        parts.push_back(condition(part, text.parts[i]));
      }
      const auto kind = text.kind == "not"   ? DriveCondition::Kind::kNot
                        : text.kind == "all" ? DriveCondition::Kind::kAll
                                             : DriveCondition::Kind::kAny;
      return DriveCondition::combine(kind, std::move(parts));
    }
    if (text.equals && text.differs) {
      report(pointer, "has equals and differs; expected one of them");
      return {};
    }
    DriveRegister looked_at = reg(pointer + "/register", text.reg, true);
    const std::uint32_t all = looked_at.type == RegisterType::kBit ? 1U : 0xFFFFFFFFU;
    const auto mask = static_cast<std::uint32_t>(text.mask.value_or(all));
    if (mask == 0) report(pointer + "/mask", "0 is not accepted; expected at least one bit");
    const auto number = static_cast<std::uint32_t>(text.differs ? *text.differs : text.equals.value_or(mask));
    return DriveCondition::compare(std::move(looked_at), mask, number, !text.differs);
  }

  void build_status() {
    profile_.enabled = condition("/status/enabled", document_.enabled);
    profile_.moving = condition("/status/moving", document_.moving);
    profile_.in_position = condition("/status/in_position", document_.in_position);
    profile_.alarm = condition("/status/alarm", document_.alarm);
    if (document_.homed_word.empty()) {
      profile_.homed = condition("/status/homed", document_.homed);
    } else if (!profile_.target && !is_reported(problems_, "/target_register")) {
      report("/target_register", "is missing: without a bit for homed it tells a restart of the drive");
    }
    const auto build_optional = [this](const char* name, const std::optional<ConditionDocument>& text,
                                       std::optional<DriveCondition>& target) {
      if (text) target = condition(std::string("/status/") + name, *text);
    };
    build_optional("limit_positive", document_.limit_positive, profile_.limit_positive);
    build_optional("limit_negative", document_.limit_negative, profile_.limit_negative);
    build_optional("emergency_stop", document_.emergency_stop, profile_.emergency_stop);
  }

  std::vector<RegisterWrite> values(const std::string& pointer, const std::vector<ValueDocument>& texts, bool frame) {
    std::vector<RegisterWrite> writes;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const std::string at = pointer + "/" + std::to_string(i);
      DriveValue value = texts[i].number;
      if (texts[i].variable == "$target") value = DriveVariable::kTarget;
      if (texts[i].variable == "$speed") value = DriveVariable::kSpeed;
      if (texts[i].variable == "$acceleration") value = DriveVariable::kAcceleration;
      RegisterWrite write{reg(at + "/0", texts[i].reg, !frame), value};
      if (const auto* plain = std::get_if<std::int64_t>(&value)) require_fits(at, write.reg, *plain);
      const bool known = !write.reg.name.empty() && (writes.empty() || !writes.back().reg.name.empty());
      if (frame && known && !writes.empty()) {
        const DriveRegister& last = writes.back().reg;
        if (write.reg.address != last.address + last.words() || write.reg.table != last.table) {
          report(at, "registers of one frame must follow each other; start another frame");
        }
      }
      if (frame && (write.reg.table == ModbusTable::kInput || write.reg.table == ModbusTable::kDiscrete)) {
        report(at, "'" + write.reg.name + "' stands in a table that cannot be written; expected holding or coil");
      }
      writes.push_back(std::move(write));
    }
    return writes;
  }

  DriveStep step(const std::string& pointer, const StepDocument& text) {
    using std::chrono::milliseconds;
    const std::string inner = pointer + "/" + text.kind;
    if (text.kind == "write") return WriteStep{values(inner, text.values, true), text.repeatable};
    if (text.kind == "expect") return ExpectStep{values(inner, text.values, false)};
    if (text.kind == "delay_ms") return DelayStep{milliseconds(text.delay_ms)};
    if (text.kind == "wait") return WaitStep{condition(inner, text.condition), milliseconds(text.timeout_ms)};
    if (text.kind == "if") {
      auto branch = std::make_shared<BranchStep>();
      branch->condition = condition(inner, text.condition);
      branch->then = sequence(pointer + "/then", text.then);
      branch->otherwise = sequence(pointer + "/else", text.otherwise);
      return std::shared_ptr<const BranchStep>(std::move(branch));
    }
    DriveRegister changed = reg(inner + "/register", text.reg, true);
    if (text.kind == "modify") {
      return ModifyStep{std::move(changed), static_cast<std::uint32_t>(text.set),
                        static_cast<std::uint32_t>(text.clear)};
    }
    const auto mask = static_cast<std::uint32_t>(text.mask.value_or(changed.type == RegisterType::kBit ? 1 : 0));
    if (mask == 0) report(inner + "/mask", "is missing or 0; expected the bits of the pulse");
    return PulseStep{std::move(changed), mask, milliseconds(text.on_ms), milliseconds(text.off_ms)};
  }

  DriveSequence sequence(const std::string& pointer, const std::vector<StepDocument>& texts) {
    DriveSequence steps;
    for (std::size_t i = 0; i < texts.size(); ++i) steps.push_back(step(pointer + "/" + std::to_string(i), texts[i]));
    return steps;
  }

  void build_sequences() {
    profile_.prepare = sequence("/sequences/prepare", document_.prepare);
    profile_.enable = sequence("/sequences/enable", document_.enable);
    profile_.disable = sequence("/sequences/disable", document_.disable);
    profile_.home = sequence("/sequences/home", document_.home);
    profile_.move_absolute = sequence("/sequences/move_absolute", document_.move_absolute);
    profile_.stop = sequence("/sequences/stop", document_.stop);
    profile_.alarm_reset = sequence("/sequences/alarm_reset", document_.alarm_reset);
    if (!problems_.empty()) return;
    for (const auto& [name, steps] :
         {std::pair{"home", &profile_.home}, {"move_absolute", &profile_.move_absolute}, {"stop", &profile_.stop}}) {
      if (steps->empty()) report(std::string("/sequences/") + name, "[] is not accepted; it needs at least one step");
    }
    for (const char* variable : {"$target", "$speed"}) {
      if (!document_.move_absolute.empty() && !writes(document_.move_absolute, variable)) {
        report("/sequences/move_absolute", std::string("writes no ") + variable +
                                               ": every move has its own; expected it among the values of a write");
      }
    }
  }

  [[nodiscard]] static bool writes(const std::vector<StepDocument>& steps, const std::string& variable) {
    return std::any_of(steps.begin(), steps.end(), [&](const StepDocument& step) {
      const auto holds = [&](const ValueDocument& value) { return value.variable == variable; };
      return (step.kind == "write" && std::any_of(step.values.begin(), step.values.end(), holds)) ||
             writes(step.then, variable) || writes(step.otherwise, variable);
    });
  }

  void build_alarms() {
    for (const auto& [code, text] : document_.alarms) {
      const bool hex = code.starts_with("0x");
      const char* end = code.data() + code.size();
      int number = 0;
      const auto [parsed, error] = std::from_chars(code.data() + (hex ? 2 : 0), end, number, hex ? 16 : 10);
      if (error != std::errc{} || parsed != end || number < 0) {
        report("/alarms/" + code, "the key is not accepted; expected a code, 0..2147483647 or 0x0..0x7FFFFFFF");
        continue;
      }
      DriveAlarm alarm = text.alarm;
      if (!text.words.empty()) alarm.text = text.words;
      profile_.alarms[number] = std::move(alarm);
    }
  }

  void build_extras() {
    for (std::size_t i = 0; i < document_.identify.size(); ++i) {
      const IdentityDocument& text = document_.identify[i];
      profile_.identify.push_back({condition("/identify/" + std::to_string(i), text.condition), text.text});
    }
    for (std::size_t i = 0; i < document_.watch.size(); ++i) {
      profile_.watched.push_back(reg("/watch/" + std::to_string(i) + "/register", document_.watch[i].reg, true));
    }
    if (const auto& text = document_.watchdog) {
      profile_.watchdog = {reg("/watchdog/register", text->reg, true), text->armed, text->disarmed};
      require_fits("/watchdog/armed", profile_.watchdog->reg, text->armed);
      require_fits("/watchdog/disarmed", profile_.watchdog->reg, text->disarmed);
    }
    if (const auto& text = document_.soft_limits) {
      profile_.soft_limits = {reg("/soft_limits/positive", text->positive, true),
                              reg("/soft_limits/negative", text->negative, true)};
    }
    for (const auto& [name, text] : document_.labels) {
      profile_.labels.push_back({name, reg("/labels/" + name + "/register", text.reg, true)});
    }
    for (const auto& [name, text] : document_.temperatures) {
      profile_.temperatures.push_back(
          {name, reg("/temperatures/" + name + "/register", text.reg, true), text.celsius_per_unit});
    }
  }

  /// What is looked at in every sample stands in the blocks that are read for it.
  void check_poll_blocks() {
    const auto polled = [this](const std::string& pointer, const DriveRegister& one) {
      const bool inside =
          std::any_of(profile_.poll.begin(), profile_.poll.end(), [&](const PollBlock& b) { return b.holds(one); });
      if (inside) return;
      report(pointer, "its register '" + one.name + "' at " + std::to_string(one.address) +
                          " is in none of the blocks of /poll; expected a block that holds it");
    };
    polled("/feedback/register", profile_.position);
    for (const auto& [name, condition] : {std::pair{"enabled", &profile_.enabled},
                                          {"moving", &profile_.moving},
                                          {"in_position", &profile_.in_position},
                                          {"alarm", &profile_.alarm}}) {
      for (const DriveRegister& one : condition->registers()) polled(std::string("/status/") + name, one);
    }
    for (const auto& [name, condition] : {std::pair{"homed", &profile_.homed},
                                          {"limit_positive", &profile_.limit_positive},
                                          {"limit_negative", &profile_.limit_negative},
                                          {"emergency_stop", &profile_.emergency_stop}}) {
      if (!*condition) continue;
      for (const DriveRegister& one : (*condition)->registers()) polled(std::string("/status/") + name, one);
    }
    if (problems_.empty() && !profile_.poll.back().holds(profile_.position)) {
      report("/poll", "the last block must hold the position, so that no status is newer than it");
    }
  }

  const DriveDocument& document_;
  Problems& problems_;
  DriveProfile profile_;
  std::map<std::string, DriveRegister> registers_;
};

}  // namespace

DriveProfile build_drive_profile(const DriveDocument& document, Problems& problems) {
  return ProfileBuilder(document, problems).build();
}

}  // namespace fvd
