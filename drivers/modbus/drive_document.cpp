/// The keys of a drive profile: names, ranges, meanings.

#include "drivers/modbus/drive_document.hpp"

namespace fvd {

namespace {

constexpr IntegerRange kRegisterValue{0, 2147483647};
constexpr IntegerRange kAddress{0, 65535, true};
constexpr IntegerRange kBits{0, UINT32_MAX, true};
constexpr IntegerRange kTime_ms{0, 600000, true};
constexpr std::int64_t kMaxFrameRegisters = 123;
constexpr std::int64_t kMaxSteps = 1000;
constexpr std::size_t kMaxNameLength = 64;

void required_name(Fields& fields, std::string_view key, std::string& name, std::string_view meaning) {
  fields.text(key, name, kMaxNameLength, meaning);
  fields.require(key);
}

void optional_bits(Fields& fields, std::string_view key, std::optional<std::int64_t>& bits, std::string_view meaning) {
  fields.optional(key, bits, [&](Fields& inner, std::int64_t& value) { inner.integer64(key, value, kBits, meaning); });
}

void required_time(Fields& fields, std::string_view key, std::int64_t& time_ms, std::string_view meaning) {
  fields.integer64(key, time_ms, kTime_ms, meaning);
  fields.require(key);
}

void describe_register(RegisterDocument& reg, Fields& fields) {
  fields.integer64("address", reg.address, kAddress, "PDU address, 0-based");
  fields.require("address");
  fields.choice("type", reg.type, {"bit", "u16", "i16", "u32", "i32"}, "how its words make a number");
  fields.require("type");
  fields.choice("table", reg.table, {"holding", "input", "coil", "discrete"}, "where it stands");
  fields.choice("codec", reg.codec, {"plain", "base1000"},
                "base1000: of two words the upper holds thousands, the lower 0..999");
  fields.optional("word_order", reg.word_order, [](Fields& inner, std::string& order) {
    inner.choice("word_order", order, {"high_first", "low_first"}, "where it is not the profile's");
  });
  fields.optional("write_function", reg.write_function, [](Fields& inner, std::int64_t& function) {
    inner.integer64("write_function", function, {5, 16}, "5 or 15 for coils, 6 or 16 for registers");
  });
  fields.choice("access", reg.access, {"read_write", "write"}, "write: a command register, which is never read");
}

void describe_condition(ConditionDocument& condition, Fields& fields) {
  const auto parts = [&](const char* key, const char* meaning) {
    return Shape{key, [&condition, key, meaning](Fields& inner) {
                   inner.list(key, condition.parts, {1, 32}, meaning,
                              [](Fields& part, ConditionDocument& one) { describe_condition(one, part); },
                              {"condition"});
                 }};
  };
  const Shape compared{"register", [&](Fields& inner) {
                         required_name(inner, "register", condition.reg, "that is looked at");
                         optional_bits(inner, "mask", condition.mask, "of its bits; none = all");
                         optional_bits(inner, "equals", condition.equals,
                                       "holds where the bits are these; without equals and differs: all of the mask");
                         optional_bits(inner, "differs", condition.differs, "holds where the bits are not these");
                       }};
  const Shape inverted{"not", [&](Fields& inner) {
                         ConditionDocument part;
                         if (!condition.parts.empty()) part = condition.parts.front();
                         inner.group_of("condition", "not", "does not hold",
                                        [&](Fields& one) { describe_condition(part, one); });
                         condition.parts = {std::move(part)};
                       }};
  fields.keyed_variant(condition.kind,
                       {compared, inverted, parts("all", "all of them hold"), parts("any", "one does")});
}

void condition_field(Fields& fields, std::string_view key, ConditionDocument& condition, std::string_view meaning) {
  fields.group_of("condition", key, meaning, [&](Fields& inner) { describe_condition(condition, inner); });
}

void optional_condition(Fields& fields, std::string_view key, std::optional<ConditionDocument>& condition,
                        std::string_view meaning) {
  fields.optional(key, condition,
                  [&](Fields& inner, ConditionDocument& value) { condition_field(inner, key, value, meaning); });
}

void describe_value(Fields& fields, ValueDocument& value) {
  required_name(fields, "0", value.reg, "register");
  fields.word_or("1", value.variable, {"$target", "$speed", "$acceleration"}, [&](Fields& inner) {
    inner.integer64("1", value.number, {INT32_MIN, UINT32_MAX, true}, "value");
  });
  fields.require("1");
}

void steps_field(Fields& fields, std::string_view key, std::vector<StepDocument>& steps, std::string_view meaning);

void describe_step(StepDocument& step, Fields& fields) {
  const auto values = [&](const char* key, const char* meaning) {
    return [&step, key, meaning](Fields& inner) {
      inner.list(key, step.values, {1, kMaxFrameRegisters}, meaning, describe_value, {"", true});
    };
  };
  const Shape write{
      "write", [&](Fields& inner) {
        values("write", "[register, value], ...: registers that follow each other, one frame")(inner);
        inner.boolean(
            "repeatable", step.repeatable,
            "it does no harm twice: sent again while the drive is busy, and twice more where no answer comes");
      }};
  const Shape pulse{"pulse", [&](Fields& inner) {
                      inner.group("pulse", "sets bits, holds them, clears them", [&](Fields& in) {
                        required_name(in, "register", step.reg, "that has the bits");
                        optional_bits(in, "mask", step.mask, "the bits; of a bit 1");
                        required_time(in, "on_ms", step.on_ms, "how long they are set");
                        required_time(in, "off_ms", step.off_ms, "how long they are cleared at least");
                      });
                    }};
  const Shape modify{"modify", [&](Fields& inner) {
                       inner.group("modify", "reads, changes some bits, writes", [&](Fields& in) {
                         required_name(in, "register", step.reg, "that has the bits");
                         in.integer64("set", step.set, kBits, "bits that become 1");
                         in.integer64("clear", step.clear, kBits, "bits that become 0");
                       });
                     }};
  const Shape wait{"wait", [&](Fields& inner) {
                     condition_field(inner, "wait", step.condition, "until this holds");
                     required_time(inner, "timeout_ms", step.timeout_ms, "later fails the sequence");
                   }};
  const Shape delay{"delay_ms", [&](Fields& inner) { required_time(inner, "delay_ms", step.delay_ms, "a pause"); }};
  const Shape branch{"if", [&](Fields& inner) {
                       condition_field(inner, "if", step.condition, "chooses then or else");
                       steps_field(inner, "then", step.then, "where it holds");
                       inner.require("then");
                       steps_field(inner, "else", step.otherwise, "where it does not");
                     }};
  fields.keyed_variant(step.kind,
                       {write,
                        pulse,
                        modify,
                        wait,
                        delay,
                        {"expect", values("expect", "[register, value], ...: read back, or the sequence fails")},
                        branch});
}

void steps_field(Fields& fields, std::string_view key, std::vector<StepDocument>& steps, std::string_view meaning) {
  fields.list(key, steps, {0, kMaxSteps}, meaning,
              [](Fields& inner, StepDocument& step) { describe_step(step, inner); }, {"step"});
}

void describe_scale(DriveDocument& document, Fields& scale) {
  DriveProfile& plain = document.plain;
  scale.number("steps_per_um", plain.steps_per_um, positive(1e6), "commanded steps per um");
  scale.require("steps_per_um");
  scale.choice("direction", document.direction, {"positive", "negative"}, "sign of the steps when z grows");
  scale.number("lead_um", plain.lead_um, {0.0, 1e6}, "screw lead, the period of its error; 0 = unknown");
  scale.number("speed_units_per_um_s", plain.speed.factor, positive(1e9), "register value per um/s");
  scale.require("speed_units_per_um_s");
  scale.integer("speed_min", plain.speed.min, kRegisterValue, "smallest register value; lower ones become it");
  scale.integer("speed_max", plain.speed.max, kRegisterValue, "largest register value; higher ones become it");
  scale.optional("acceleration_units_per_um_s2", document.acceleration_units_per_um_s2,
                 [](Fields& inner, double& factor) {
                   inner.number("acceleration_units_per_um_s2", factor, positive(1e9),
                                "register value per um/s^2; required without acceleration_inverse_um_s2");
                 });
  scale.number("acceleration_inverse_um_s2", document.acceleration_inverse_um_s2, {0.0, 1e15},
               "register value times um/s^2, for drives that take a time; 0 = the drive takes none");
  scale.integer("acceleration_min", plain.acceleration.min, kRegisterValue, "as speed_min");
  scale.integer("acceleration_max", plain.acceleration.max, kRegisterValue, "as speed_max");
}

void describe_feedback(DriveDocument& document, Fields& feedback) {
  feedback.choice("source", document.feedback_source, {"none", "motor_encoder", "linear_scale"},
                  "none = not observable");
  feedback.require("source");
  required_name(feedback, "register", document.feedback_register, "register of the position");
  feedback.number("counts_per_um", document.plain.counts_per_um, positive(1e6), "counts per um");
  feedback.require("counts_per_um");
  feedback.number("resolution_um", document.plain.feedback_resolution_um, {0.0, 1000.0},
                  "smallest step of the reading");
}

void describe_block(Fields& fields, PollBlock& block) {
  fields.integer("address", block.address, kAddress, "PDU address of the first");
  fields.require("address");
  fields.integer("count", block.count, {1, 125, true}, "registers");
  fields.require("count");
  std::string table = block.table == ModbusTable::kInput ? "input" : "holding";
  fields.choice("table", table, {"holding", "input"}, "where they stand");
  block.table = table == "input" ? ModbusTable::kInput : ModbusTable::kHolding;
}

void describe_status(DriveDocument& document, Fields& status) {
  const auto wanted = [&](const char* key, ConditionDocument& condition, const char* meaning) {
    condition_field(status, key, condition, meaning);
    status.require(key);
  };
  wanted("enabled", document.enabled, "the motor holds its position");
  status.word_or("homed", document.homed_word, {"remembered"}, [&](Fields& inner) {
    condition_field(inner, "homed", document.homed,
                    "the position has a reference; remembered = since the last homing, for drives without such a bit");
  });
  status.require("homed");
  wanted("moving", document.moving, "the axis moves");
  wanted("in_position", document.in_position, "the move has ended at its target");
  wanted("alarm", document.alarm, "the drive has stopped with an alarm");
  optional_condition(status, "limit_positive", document.limit_positive, "at the switch in the direction of more steps");
  optional_condition(status, "limit_negative", document.limit_negative, "at the other switch");
  optional_condition(status, "emergency_stop", document.emergency_stop, "the safety input is open");
}

void describe_sequences(DriveDocument& document, Fields& sequences) {
  const auto wanted = [&](const char* key, std::vector<StepDocument>& steps, const char* meaning) {
    steps_field(sequences, key, steps, meaning);
    sequences.require(key);
  };
  steps_field(sequences, "prepare", document.prepare,
              "settings, sent before the first motion and whenever the drive is enabled; takes no torque");
  wanted("enable", document.enable, "gives torque, sent where status.enabled does not hold; [] = nothing to do");
  steps_field(sequences, "disable", document.disable, "takes the motor's current away");
  wanted("home", document.home, "starts the homing");
  wanted("move_absolute", document.move_absolute, "starts a move");
  wanted("stop", document.stop, "brings the axis to rest");
  wanted("alarm_reset", document.alarm_reset, "clears an alarm");
}

void describe_alarm(Fields& fields, const std::string& code, AlarmDocument& alarm) {
  fields.word_or(code, alarm.words, {}, [&](Fields& inner) {
    inner.group(code, "what the code says", [&](Fields& in) {
      in.text("text", alarm.alarm.text, kMaxWordLength, "for people");
      in.require("text");
      in.boolean("resettable", alarm.alarm.resettable, "false: only by switching the drive off and on");
      in.boolean("position_lost", alarm.alarm.position_lost, "home again after the reset");
    });
  });
}

void describe_extras(DriveDocument& document, Fields& fields) {
  fields.list("identify", document.identify, {0, 32},
              "conditions that tell which drive this is, checked before any write",
              [](Fields& inner, IdentityDocument& identity) {
                inner.text("text", identity.text, kMaxWordLength, "what it is, for people");
                inner.require("text");
                describe_condition(identity.condition, inner);
              });
  fields.list("watch", document.watch, {0, 32},
              "registers that only the drive's master writes: a value that fvd did not write is another master's",
              [](Fields& inner, WatchedDocument& watched) {
                required_name(inner, "register", watched.reg, "such as the target or the control word");
              });
  fields.optional("watchdog", document.watchdog, [](Fields& outer, WatchdogDocument& watchdog) {
    outer.group("watchdog", "stops the drive by itself when nothing is heard", [&](Fields& in) {
      required_name(in, "register", watchdog.reg, "of the time");
      in.integer64("armed", watchdog.armed, kBits, "its value while fvd is connected");
      in.require("armed");
      in.integer64("disarmed", watchdog.disarmed, kBits, "its value after that");
      in.require("disarmed");
    });
  });
  fields.optional("soft_limits", document.soft_limits, [](Fields& outer, SoftLimitsDocument& limits) {
    outer.group("soft_limits", "registers of the drive's own limits, in steps: the configured ones lie within",
                [&](Fields& in) {
                  required_name(in, "positive", limits.positive, "register of the upper limit");
                  required_name(in, "negative", limits.negative, "register of the lower limit");
                });
  });
  fields.map("labels", document.labels, "by what they are, such as serial or firmware: told with the drive's name",
             [](Fields& outer, const std::string& key, LabelDocument& label) {
               outer.group(key, "a number by which a single drive is known",
                           [&](Fields& in) { required_name(in, "register", label.reg, "that holds it"); });
             });
  fields.map("temperatures", document.temperatures, "by what is measured",
             [](Fields& outer, const std::string& key, TemperatureDocument& temperature) {
               outer.group(key, "a temperature", [&](Fields& in) {
                 required_name(in, "register", temperature.reg, "that holds it");
                 in.number("celsius_per_unit", temperature.celsius_per_unit, {}, "degC per unit of the register");
               });
             });
}

}  // namespace

void describe(DriveDocument& document, Fields& fields) {
  DriveProfile& plain = document.plain;
  required_name(fields, "name", plain.name, "of the drive family");
  fields.text("vendor", plain.vendor, 64, "maker");
  fields.text("manual", plain.manual, 256, "where the register map stands");
  fields.choice("word_order", document.word_order, {"high_first", "low_first"},
                "order of the words of 32-bit registers");
  required_name(fields, "alarm_register", document.alarm_register, "register of the alarm code");
  fields.optional("target_register", document.target_register, [](Fields& inner, std::string& name) {
    inner.text("target_register", name, kMaxNameLength,
               "reads back the last target; needed where status.homed is \"remembered\"");
  });
  fields.map("registers", document.registers, "the drive's registers by names of the profile's own",
             [](Fields& outer, const std::string& key, RegisterDocument& reg) {
               outer.group(key, "a register", [&](Fields& in) { describe_register(reg, in); });
             });
  fields.require("registers");
  fields.group("scale", "units of the drive", [&](Fields& in) { describe_scale(document, in); });
  fields.require("scale");
  fields.group("feedback", "where the measured position comes from",
               [&](Fields& in) { describe_feedback(document, in); });
  fields.require("feedback");
  fields.list("poll", plain.poll, {1, 32}, "blocks that are read for each sample, the one with the position last",
              describe_block);
  fields.require("poll");
  fields.group("timing", "how long the drive may take", [&](Fields& timing) {
    auto start_ms = plain.start_within.count();
    auto home_ms = plain.home_timeout.count();
    timing.integer("start_within_ms", start_ms, {1, 10000}, "a move not begun by then was refused");
    timing.integer("home_timeout_ms", home_ms, {100, 600000}, "for the whole homing");
    plain.start_within = std::chrono::milliseconds(start_ms);
    plain.home_timeout = std::chrono::milliseconds(home_ms);
  });
  fields.group("status", "what the drive says of itself", [&](Fields& in) { describe_status(document, in); });
  fields.require("status");
  fields.group("sequences", "what is sent to it", [&](Fields& in) { describe_sequences(document, in); });
  fields.require("sequences");
  fields.boolean("alarms_are_bits", plain.alarms_are_bits,
                 "true: the alarm register is a bit mask, and the codes are its single bits");
  fields.map("alarms", document.alarms, "by the code of the alarm, a number or \"0x..\"", describe_alarm);
  fields.require("alarms");
  describe_extras(document, fields);
}

}  // namespace fvd
