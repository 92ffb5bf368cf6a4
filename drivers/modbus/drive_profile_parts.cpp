#include "drivers/modbus/drive_profile_parts.hpp"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

namespace fvd {

namespace {

using nlohmann::json;

constexpr std::int64_t kLongestTime_ms = 600000;

/// The entry of `table` that a text names.
template <typename Value>
std::optional<Value> choice(const json& value, const std::map<std::string, Value>& table) {
  if (!value.is_string()) return std::nullopt;
  const auto found = table.find(value.get<std::string>());
  return found == table.end() ? std::nullopt : std::optional(found->second);
}

template <typename Value>
std::string names_of(const std::map<std::string, Value>& table) {
  std::string names;
  for (const auto& [name, value] : table) names += (names.empty() ? "one of \"" : "\", \"") + name;
  return names + "\"";
}

}  // namespace

void ProfileParts::report(const std::string& pointer, const json& value, const std::string& expected) {
  problems_.push_back({pointer, value.dump() + " is not accepted; expected " + expected});
}

std::optional<std::int64_t> ProfileParts::number(const std::string& pointer, const json& value, std::int64_t min,
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

void ProfileParts::refuse_other_keys(const std::string& pointer, const json& object,
                                     const std::set<std::string>& known) {
  for (const auto& [key, value] : object.items()) {
    if (!known.contains(key)) problems_.push_back({pointer + "/" + key, "unknown key"});
  }
}

void ProfileParts::read_registers(const json& registers, WordOrder order) {
  for (const auto& [name, value] : registers.items()) {
    DriveRegister reg = read_register("/registers/" + name, value, order);
    reg.name = name;
    registers_[name] = std::move(reg);
  }
}

DriveRegister ProfileParts::read_register(const std::string& pointer, const json& value, WordOrder order) {
  static const std::map<std::string, RegisterType> kTypes{{"bit", RegisterType::kBit},
                                                          {"u16", RegisterType::kU16},
                                                          {"i16", RegisterType::kI16},
                                                          {"u32", RegisterType::kU32},
                                                          {"i32", RegisterType::kI32}};
  static const std::map<std::string, WordOrder> kOrders{{"high_first", WordOrder::kHighFirst},
                                                        {"low_first", WordOrder::kLowFirst}};
  static const std::map<std::string, RegisterCodec> kCodecs{{"plain", RegisterCodec::kPlain},
                                                            {"base1000", RegisterCodec::kBase1000}};
  static const std::map<std::string, ModbusTable> kTables{{"holding", ModbusTable::kHolding},
                                                          {"input", ModbusTable::kInput},
                                                          {"coil", ModbusTable::kCoil},
                                                          {"discrete", ModbusTable::kDiscrete}};
  DriveRegister reg;
  reg.order = order;
  if (!value.is_object() || !value.contains("address") || !value.contains("type")) {
    report(pointer, value, "an object with address and type");
    return reg;
  }
  refuse_other_keys(pointer, value, {"address", "type", "table", "codec", "word_order", "write_function", "access"});
  reg.address = static_cast<int>(number(pointer + "/address", value["address"], 0, 65535).value_or(0));
  const auto pick = [&](const char* key, const auto& table, auto& target) {
    if (!value.contains(key)) return;
    if (const auto found = choice(value[key], table)) {
      target = *found;
    } else {
      report(pointer + "/" + key, value[key], names_of(table));
    }
  };
  pick("type", kTypes, reg.type);
  pick("table", kTables, reg.table);
  pick("codec", kCodecs, reg.codec);
  pick("word_order", kOrders, reg.order);
  static const std::map<std::string, bool> kAccess{{"read_write", true}, {"write", false}};
  pick("access", kAccess, reg.readable);
  if (value.contains("write_function")) {
    const json& function = value["write_function"];
    if (function == 5 || function == 6 || function == 15 || function == 16) {
      reg.write_single = function == 5 || function == 6;
    } else {
      report(pointer + "/write_function", function, "5 or 15 for coils, 6 or 16 for registers");
    }
  }
  const bool bit_table = reg.table == ModbusTable::kCoil || reg.table == ModbusTable::kDiscrete;
  if (bit_table != (reg.type == RegisterType::kBit)) {
    problems_.push_back({pointer, "type \"bit\" belongs to the tables coil and discrete, all others to registers"});
  }
  if (reg.codec == RegisterCodec::kBase1000 && reg.words() != 2) {
    problems_.push_back({pointer + "/codec", "base1000 needs two words: type u32 or i32"});
  }
  return reg;
}

DriveRegister ProfileParts::known_register(const std::string& pointer, const json& name, bool to_read) {
  if (!name.is_string()) {
    report(pointer, name, "the name of a register");
    return {};
  }
  const auto found = registers_.find(name.get<std::string>());
  if (found == registers_.end()) {
    problems_.push_back({pointer, "'" + name.get<std::string>() + "' is not one of the profile's registers"});
    return {};
  }
  if (to_read && !found->second.readable) {
    problems_.push_back({pointer, "'" + found->first + "' can only be written, says its \"access\""});
  }
  return found->second;
}

std::uint32_t ProfileParts::bits(const std::string& pointer, const json& object, const char* key,
                                 std::uint32_t otherwise) {
  if (!object.contains(key)) return otherwise;
  return static_cast<std::uint32_t>(number(pointer + "/" + key, object[key], 0, 0xFFFFFFFF).value_or(otherwise));
}

std::chrono::milliseconds ProfileParts::time(const std::string& pointer, const json& object, const char* key) {
  if (!object.contains(key)) {
    problems_.push_back({pointer + "/" + key, "is missing and has no default"});
    return {};
  }
  return std::chrono::milliseconds(number(pointer + "/" + key, object[key], 0, kLongestTime_ms).value_or(0));
}

DriveCondition ProfileParts::condition(const std::string& pointer, const json& value) {
  if (value.is_object() && value.size() == 1) {
    const std::string& key = value.begin().key();
    const json& inner = value.begin().value();
    if (key == "not") return DriveCondition::combine(DriveCondition::Kind::kNot, {condition(pointer + "/not", inner)});
    if (key == "all" || key == "any") {
      std::vector<DriveCondition> parts;
      if (!inner.is_array() || inner.empty()) report(pointer + "/" + key, inner, "a list of conditions");
      for (std::size_t i = 0; inner.is_array() && i < inner.size(); ++i) {
        parts.push_back(condition(pointer + "/" + key + "/" + std::to_string(i), inner[i]));
      }
      return DriveCondition::combine(key == "all" ? DriveCondition::Kind::kAll : DriveCondition::Kind::kAny,
                                     std::move(parts));
    }
  }
  if (!value.is_object() || !value.contains("register") || (value.contains("equals") && value.contains("differs"))) {
    report(pointer, value,
           "an object with register and, of these, mask, equals or differs; or with one of not, all, any");
    return {};
  }
  refuse_other_keys(pointer, value, {"register", "mask", "equals", "differs"});
  DriveRegister reg = known_register(pointer + "/register", value["register"], true);
  const std::uint32_t mask = bits(pointer, value, "mask", reg.type == RegisterType::kBit ? 1U : 0xFFFFFFFFU);
  if (mask == 0) report(pointer + "/mask", value["mask"], "at least one bit");
  const bool equals = !value.contains("differs");
  return DriveCondition::compare(std::move(reg), mask, bits(pointer, value, equals ? "equals" : "differs", mask),
                                 equals);
}

DriveValue ProfileParts::value_of(const std::string& pointer, const json& value) {
  static const std::map<std::string, DriveVariable> kVariables{{"$target", DriveVariable::kTarget},
                                                               {"$speed", DriveVariable::kSpeed},
                                                               {"$acceleration", DriveVariable::kAcceleration}};
  if (value.is_string() && value.get<std::string>().starts_with("$")) {
    if (const auto found = choice(value, kVariables)) return *found;
    report(pointer, value, "one of \"$target\", \"$speed\", \"$acceleration\"");
    return std::int64_t{0};
  }
  return number(pointer, value, INT32_MIN, UINT32_MAX).value_or(0);
}

std::vector<RegisterWrite> ProfileParts::values(const std::string& pointer, const json& list, bool contiguous) {
  std::vector<RegisterWrite> writes;
  if (!list.is_array() || list.empty()) {
    report(pointer, list, "a list [[register, value], ...]");
    return writes;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string at = pointer + "/" + std::to_string(i);
    const json& pair = list[i];
    if (!pair.is_array() || pair.size() != 2) {
      report(at, pair, "[register, value]");
      continue;
    }
    RegisterWrite write{known_register(at + "/0", pair[0], !contiguous), value_of(at + "/1", pair[1])};
    if (contiguous && !writes.empty()) {
      const DriveRegister& last = writes.back().reg;
      if (write.reg.address != last.address + last.words() || write.reg.table != last.table) {
        problems_.push_back({at, "registers of one frame must follow each other; start another frame"});
      }
    }
    if (contiguous && (write.reg.table == ModbusTable::kInput || write.reg.table == ModbusTable::kDiscrete)) {
      problems_.push_back({at, "'" + write.reg.name + "' stands in a table that cannot be written"});
    }
    writes.push_back(std::move(write));
  }
  return writes;
}

std::optional<DriveStep> ProfileParts::step(const std::string& pointer, const json& value) {
  const auto has = [&](const char* key) { return value.is_object() && value.contains(key); };
  const auto inner = [&](const char* key) -> const json& { return value[key]; };
  if (has("write")) {
    refuse_other_keys(pointer, value, {"write", "repeatable"});
    WriteStep step{values(pointer + "/write", inner("write"), true), false};
    if (has("repeatable")) {
      if (inner("repeatable").is_boolean()) {
        step.repeatable = inner("repeatable").get<bool>();
      } else {
        report(pointer + "/repeatable", inner("repeatable"), "true or false");
      }
    }
    if (step.writes.empty()) return std::nullopt;
    return step;
  }
  if (has("expect")) {
    refuse_other_keys(pointer, value, {"expect"});
    return ExpectStep{values(pointer + "/expect", inner("expect"), false)};
  }
  if (has("delay_ms")) {
    refuse_other_keys(pointer, value, {"delay_ms"});
    return DelayStep{time(pointer, value, "delay_ms")};
  }
  if (has("wait")) {
    refuse_other_keys(pointer, value, {"wait", "timeout_ms"});
    return WaitStep{condition(pointer + "/wait", inner("wait")), time(pointer, value, "timeout_ms")};
  }
  if (has("if") && has("then")) {
    refuse_other_keys(pointer, value, {"if", "then", "else"});
    auto branch = std::make_shared<BranchStep>();
    branch->condition = condition(pointer + "/if", inner("if"));
    branch->then = sequence(pointer + "/then", inner("then"));
    if (has("else")) branch->otherwise = sequence(pointer + "/else", inner("else"));
    return std::shared_ptr<const BranchStep>(std::move(branch));
  }
  for (const char* kind : {"pulse", "modify"}) {
    if (!has(kind)) continue;
    refuse_other_keys(pointer, value, {kind});
    const std::string at = pointer + "/" + kind;
    const json& what = inner(kind);
    if (!what.is_object() || !what.contains("register")) break;
    DriveRegister reg = known_register(at + "/register", what["register"], true);
    if (std::string(kind) == "pulse") {
      refuse_other_keys(at, what, {"register", "mask", "on_ms", "off_ms"});
      const std::uint32_t mask = bits(at, what, "mask", reg.type == RegisterType::kBit ? 1U : 0U);
      if (mask == 0) problems_.push_back({at + "/mask", "is missing or 0: expected the bits of the pulse"});
      return PulseStep{std::move(reg), mask, time(at, what, "on_ms"), time(at, what, "off_ms")};
    }
    refuse_other_keys(at, what, {"register", "set", "clear"});
    return ModifyStep{std::move(reg), bits(at, what, "set", 0), bits(at, what, "clear", 0)};
  }
  report(pointer, value,
         "one of {\"write\": [[register, value], ...]}, {\"pulse\": {register, mask, on_ms, off_ms}}, {\"modify\": "
         "{register, set, clear}}, {\"wait\": condition, \"timeout_ms\"}, {\"delay_ms\"}, {\"expect\": [[register, "
         "value], ...]}, {\"if\": condition, \"then\", \"else\"}");
  return std::nullopt;
}

DriveSequence ProfileParts::sequence(const std::string& pointer, const json& value) {
  DriveSequence steps;
  if (!value.is_array()) {
    report(pointer, value, "a list of steps");
    return steps;
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (auto one = step(pointer + "/" + std::to_string(i), value[i])) steps.push_back(std::move(*one));
  }
  return steps;
}

}  // namespace fvd
