#include "drivers/modbus/drive_check.hpp"

#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include "core/base/error.hpp"

namespace fvd {

namespace {

void collect(const DriveSequence& sequence, std::map<std::string, DriveRegister>& registers) {
  const auto add = [&](const DriveRegister& reg) { registers[reg.name] = reg; };
  for (const DriveStep& step : sequence) {
    if (const auto* write = std::get_if<WriteStep>(&step)) {
      for (const RegisterWrite& one : write->writes) add(one.reg);
    } else if (const auto* pulse = std::get_if<PulseStep>(&step)) {
      add(pulse->reg);
    } else if (const auto* modify = std::get_if<ModifyStep>(&step)) {
      add(modify->reg);
    } else if (const auto* wait = std::get_if<WaitStep>(&step)) {
      for (const DriveRegister& reg : wait->condition.registers()) add(reg);
    } else if (const auto* expect = std::get_if<ExpectStep>(&step)) {
      for (const RegisterWrite& one : expect->values) add(one.reg);
    } else if (const auto* branch = std::get_if<std::shared_ptr<const BranchStep>>(&step)) {
      for (const DriveRegister& reg : (*branch)->condition.registers()) add(reg);
      collect((*branch)->then, registers);
      collect((*branch)->otherwise, registers);
    }
  }
}

/// Every register the profile uses and that can be read, by name.
std::map<std::string, DriveRegister> registers_of(const DriveProfile& profile) {
  std::map<std::string, DriveRegister> registers;
  for (const auto* sequence : {&profile.prepare, &profile.enable, &profile.disable, &profile.home,
                               &profile.move_absolute, &profile.stop, &profile.alarm_reset}) {
    collect(*sequence, registers);
  }
  const auto add = [&](const DriveRegister& reg) { registers[reg.name] = reg; };
  const auto add_all = [&](const DriveCondition& condition) {
    for (const DriveRegister& reg : condition.registers()) add(reg);
  };
  add(profile.position);
  add(profile.alarm_code);
  if (profile.target) add(*profile.target);
  for (const auto* condition : {&profile.enabled, &profile.moving, &profile.in_position, &profile.alarm}) {
    add_all(*condition);
  }
  for (const auto* condition :
       {&profile.homed, &profile.limit_positive, &profile.limit_negative, &profile.emergency_stop}) {
    if (*condition) add_all(**condition);
  }
  for (const DriveIdentity& identity : profile.identify) add_all(identity.condition);
  for (const DriveTemperature& temperature : profile.temperatures) add(temperature.reg);
  for (const DriveLabel& label : profile.labels) add(label.reg);
  if (profile.watchdog) add(profile.watchdog->reg);
  if (profile.soft_limits) {
    add(profile.soft_limits->positive);
    add(profile.soft_limits->negative);
  }
  std::erase_if(registers, [](const auto& entry) { return !entry.second.readable; });
  return registers;
}

/// Of a number smaller than this the upper word says nothing but the sign: with its words exchanged it is a multiple of
/// 65536, which hardly any other number is.
constexpr std::int64_t kSmall = 0x8000;

/// What the register's words, in the other order, would make of it.
std::int64_t with_exchanged_words(const DriveRegister& reg, std::int64_t value) {
  if (reg.words() != 2) return value;
  DriveRegister other = reg;
  other.order = reg.order == WordOrder::kHighFirst ? WordOrder::kLowFirst : WordOrder::kHighFirst;
  return decode(other, encode(reg, value).data());
}

class Checker {
 public:
  Checker(const DriveProfile& profile, ModbusLink& link, std::stop_token stop)
      : profile_(profile), link_(link), stop_(std::move(stop)) {}

  DriveCheck run() {
    read_registers();
    read_blocks();
    look();
    judge();
    check_.link = link_.stats();
    return std::move(check_);
  }

 private:
  ModbusReply read(ModbusTable table, int address, int count) {
    ModbusReply reply = link_.read(table, address, count, ModbusPriority::kNormal, stop_);
    if (stop_.stop_requested()) throw Error(ErrorCode::kAborted, "the check of the drive was asked to stop");
    return reply;
  }

  void read_registers() {
    bool answered = false;
    for (const auto& [name, reg] : registers_of(profile_)) {
      const ModbusReply reply = read(reg.table, reg.address, reg.words());
      DriveCheck::Register entry{name, reg.address, std::nullopt, reply.error};
      if (reply.outcome == ModbusOutcome::kOk) {
        entry.value = decode(reg, reply.values.data());
        values_[name] = *entry.value;
      } else {
        std::ostringstream text;
        text << "register '" << name << "' at " << reg.address << " (0x" << std::hex << reg.address
             << ") cannot be read: " << reply.error;
        check_.disagreements.push_back(text.str());
      }
      answered = answered || reply.outcome != ModbusOutcome::kUnknown;
      check_.registers.push_back(std::move(entry));
      if (!answered && check_.registers.size() >= 2) break;
    }
    if (!answered) {
      throw Error(ErrorCode::kStageDisconnected, link_.description() + " gives no answer that can be used: " +
                                                     check_.registers.front().error + ". " + link_.advice());
    }
  }

  /// One by one a register may be readable and in a block not: drives refuse blocks with holes.
  void read_blocks() {
    for (const PollBlock& block : profile_.poll) {
      const ModbusReply reply = read(block.table, block.address, block.count);
      if (reply.outcome == ModbusOutcome::kOk) continue;
      check_.disagreements.push_back("the poll block of " + std::to_string(block.count) + " registers at " +
                                     std::to_string(block.address) + " cannot be read: " + reply.error);
    }
  }

  std::optional<bool> holds(const DriveCondition& condition) const {
    return condition.holds([this](const DriveRegister& reg) -> std::optional<std::int64_t> {
      const auto found = values_.find(reg.name);
      return found == values_.end() ? std::nullopt : std::optional(found->second);
    });
  }

  void look() {
    for (const DriveIdentity& identity : profile_.identify) {
      check_.identity.push_back({identity.text, holds(identity.condition)});
    }
    const auto add = [this](const char* name, const DriveCondition& condition) {
      check_.status.push_back({name, holds(condition)});
    };
    add("enabled", profile_.enabled);
    if (profile_.homed) add("homed", *profile_.homed);
    add("moving", profile_.moving);
    add("in_position", profile_.in_position);
    add("alarm", profile_.alarm);
    if (profile_.limit_positive) add("limit_positive", *profile_.limit_positive);
    if (profile_.limit_negative) add("limit_negative", *profile_.limit_negative);
    if (profile_.emergency_stop) add("emergency_stop", *profile_.emergency_stop);
    if (const auto found = values_.find(profile_.position.name); found != values_.end()) {
      check_.position_um = profile_.direction * static_cast<double>(found->second) / profile_.counts_per_um;
    }
    for (const DriveTemperature& temperature : profile_.temperatures) {
      const auto found = values_.find(temperature.reg.name);
      if (found == values_.end()) continue;
      check_.temperatures.push_back(
          {temperature.name, static_cast<double>(found->second) * temperature.celsius_per_unit});
    }
  }

  void judge() {
    const auto is = [this](const DriveCondition& condition) { return holds(condition).value_or(false); };
    for (const auto& identity : check_.identity) {
      if (!identity.holds.value_or(false)) {
        check_.disagreements.push_back("identity: " + identity.name + " reads otherwise: is it this drive?");
      }
    }
    if (is(profile_.alarm)) {
      const int code = static_cast<int>(
          values_.contains(profile_.alarm_code.name) ? values_.at(profile_.alarm_code.name) : std::int64_t{0});
      check_.alarm = alarm_text(profile_, code);
      if (alarms_of(profile_, code).empty()) {
        check_.doubts.push_back("the profile has no text for " + check_.alarm);
      }
    } else if (values_.contains(profile_.alarm_code.name) && values_.at(profile_.alarm_code.name) != 0) {
      // Many drives keep the code of their last alarm after its reset.
      check_.doubts.push_back("an alarm code of " + std::to_string(values_.at(profile_.alarm_code.name)) +
                              " without the alarm bit: is the mask of /status/alarm right?");
    }
    if (is(profile_.moving) && is(profile_.in_position)) {
      check_.disagreements.push_back("moving and in position at once: is one of the masks inverted?");
    }
    const bool exchanged = judge_words();
    for (const auto& temperature : check_.temperatures) {
      if (exchanged || (temperature.celsius > -40.0 && temperature.celsius < 150.0)) continue;
      std::ostringstream text;
      text << "a " << temperature.name << " temperature of " << temperature.celsius
           << " degC: is celsius_per_unit right?";
      check_.disagreements.push_back(text.str());
    }
    if (!exchanged) judge_position();
  }

  /// True, and said, if more 32-bit registers look as if their words were exchanged than look right.
  bool judge_words() {
    std::string names;
    int balance = 0;
    for (const auto& [name, reg] : registers_of(profile_)) {
      const auto found = values_.find(name);
      if (found == values_.end() || reg.words() != 2 || reg.codec != RegisterCodec::kPlain) continue;
      const std::int64_t value = found->second;
      if (value != 0 && std::abs(value) < kSmall) --balance;
      if (std::abs(value) <= UINT16_MAX || std::abs(with_exchanged_words(reg, value)) >= kSmall) continue;
      ++balance;
      names += (names.empty() ? "" : ", ") + name;
    }
    if (balance <= 0) return false;
    std::ostringstream text;
    text << "the two words of " << names << " seem to be exchanged: is /word_order right?";
    if (check_.position_um) {
      const std::int64_t other = with_exchanged_words(profile_.position, values_.at(profile_.position.name));
      text << " The position reads " << *check_.position_um << " um, in the other order "
           << profile_.direction * static_cast<double>(other) / profile_.counts_per_um << " um.";
    }
    check_.disagreements.push_back(text.str());
    return true;
  }

  /// A position that is far beyond any stage.
  void judge_position() {
    if (!check_.position_um || std::abs(*check_.position_um) <= 1e6) return;
    std::ostringstream text;
    text << "a position of " << *check_.position_um << " um: is /word_order right?";
    if (profile_.position.words() == 2) {
      const std::int64_t other = with_exchanged_words(profile_.position, values_.at(profile_.position.name));
      text << " With the other it would be " << profile_.direction * static_cast<double>(other) / profile_.counts_per_um
           << " um.";
    }
    check_.disagreements.push_back(text.str());
  }

  const DriveProfile& profile_;
  ModbusLink& link_;
  const std::stop_token stop_;
  DriveCheck check_;
  std::map<std::string, std::int64_t> values_;  // of the registers that could be read
};

}  // namespace

DriveCheck check_drive(const DriveProfile& profile, ModbusLink& link, std::stop_token stop) {
  return Checker(profile, link, std::move(stop)).run();
}

}  // namespace fvd
