#include "drivers/modbus/drive_sequence.hpp"

#include <algorithm>
#include <utility>

#include "drivers/modbus/pause.hpp"

namespace fvd {

namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr int kRepeats = 3;                 // of a write that does no harm twice
constexpr milliseconds kWaitPollPeriod{2};  // between two readings of a wait's condition

bool does_no_harm_twice(const DriveStep& step) {
  if (const auto* write = std::get_if<WriteStep>(&step)) return write->repeatable;
  if (std::holds_alternative<PulseStep>(step)) return false;  // its bits were cleared: the next edge counts
  const auto* branch = std::get_if<std::shared_ptr<const BranchStep>>(&step);
  if (branch == nullptr) return true;
  const auto all = [](const DriveSequence& steps) {
    return std::all_of(steps.begin(), steps.end(), does_no_harm_twice);
  };
  return all((*branch)->then) && all((*branch)->otherwise);
}

class Runner {
 public:
  Runner(ModbusLink& link, const DriveValues& values, ModbusPriority priority, std::stop_token stop)
      : link_(link), values_(values), priority_(priority), stop_(std::move(stop)) {}

  SequenceResult run(const DriveSequence& sequence, std::size_t first = 0) {
    for (std::size_t i = first; i < sequence.size(); ++i) {
      SequenceResult result = std::visit([this](const auto& s) { return run_step(s); }, sequence[i]);
      if (result.outcome == ModbusOutcome::kOk) continue;
      result.step = i;
      result.repeatable = does_no_harm_twice(sequence[i]);
      return result;
    }
    return {};
  }

 private:
  [[nodiscard]] std::int64_t number(const DriveValue& value) const {
    if (const auto* plain = std::get_if<std::int64_t>(&value)) return *plain;
    switch (std::get<DriveVariable>(value)) {
      case DriveVariable::kTarget:
        return values_.target;
      case DriveVariable::kSpeed:
        return values_.speed;
      case DriveVariable::kAcceleration:
        return values_.acceleration;
    }
    return 0;
  }

  static SequenceResult ended(const ModbusReply& reply, const std::string& what) {
    if (reply.outcome == ModbusOutcome::kOk) return {};
    return {reply.outcome, what + ": " + reply.error, 0, reply.later};
  }
  static SequenceResult interrupted(const std::string& what) {
    return {ModbusOutcome::kUnknown, what + ": the axis was asked to stop", 0};
  }

  SequenceResult run_step(const WriteStep& step) {
    std::vector<std::uint16_t> words;
    for (const RegisterWrite& write : step.writes) {
      const std::int64_t value = number(write.value);
      if (!holds(write.reg, value)) {
        return {ModbusOutcome::kRejected, std::to_string(value) + " does not fit into " + write.reg.name, 0};
      }
      const auto encoded = encode(write.reg, value);
      words.insert(words.end(), encoded.begin(), encoded.end());
    }
    const DriveRegister& first = step.writes.front().reg;
    // An urgent write is a stop, which may be sent as often as it takes.
    const ModbusWriting how{first.write_single, step.repeatable || priority_ == ModbusPriority::kUrgent};
    ModbusReply reply;
    for (int attempt = 0; attempt < (step.repeatable ? kRepeats : 1); ++attempt) {
      reply = link_.write(first.table, first.address, words, priority_, how, stop_);
      if (reply.outcome != ModbusOutcome::kUnknown || reply.later || stop_.stop_requested()) break;
    }
    return ended(reply, "write of " + first.name);
  }

  /// Bits that are set already make no second edge. What others change meanwhile stays: each attempt reads anew.
  SequenceResult change(const DriveRegister& reg, std::uint32_t set, std::uint32_t clear, const std::stop_token& stop) {
    const auto once = [&] {
      ModbusReply reply = link_.read(reg.table, reg.address, reg.words(), priority_, stop);
      if (reply.outcome != ModbusOutcome::kOk) return reply;
      const auto now = static_cast<std::uint32_t>(decode(reg, reply.values.data()));
      const auto words = encode(reg, std::int64_t{(now & ~clear) | set});
      return link_.write(reg.table, reg.address, words, priority_, {.single = reg.write_single});
    };
    return ended(link_.patiently(once, stop), "change of " + reg.name);
  }

  SequenceResult run_step(const ModifyStep& step) { return change(step.reg, step.set, step.clear, stop_); }

  SequenceResult run_step(const PulseStep& step) {
    SequenceResult result = change(step.reg, step.mask, 0, stop_);
    // Without an answer the drive may have set the bit, and an edge that stays set makes the next one none.
    if (result.outcome == ModbusOutcome::kUnknown) (void)change(step.reg, 0, step.mask, {});
    if (result.outcome != ModbusOutcome::kOk) return result;
    const bool on = pause(step.on, stop_);
    result = change(step.reg, 0, step.mask, {});  // a stop request leaves no bit set
    if (result.outcome != ModbusOutcome::kOk) return result;
    return on && pause(step.off, stop_) ? SequenceResult{} : interrupted("pulse of " + step.reg.name);
  }

  SequenceResult run_step(const DelayStep& step) {
    return pause(step.time, stop_) ? SequenceResult{} : interrupted("delay");
  }

  SequenceResult run_step(const WaitStep& step) {
    const auto deadline = SteadyClock::now() + step.timeout;
    for (;;) {
      const auto begun = SteadyClock::now();  // a look that began in time counts however long it took
      const auto holds = look(step.condition);
      if (!holds) return {ModbusOutcome::kUnknown, "wait: the drive does not answer", 0};
      if (*holds) return {};
      if (begun > deadline) {
        return {ModbusOutcome::kRejected,
                "wait for " + names(step.condition) + " ran out after " + std::to_string(step.timeout.count()) + " ms"};
      }
      if (!pause(kWaitPollPeriod, stop_)) return interrupted("wait");
    }
  }

  SequenceResult run_step(const ExpectStep& step) {
    for (const RegisterWrite& expected : step.values) {
      const auto value = read_register(link_, expected.reg, priority_, stop_);
      if (!value) return {ModbusOutcome::kUnknown, "read of " + expected.reg.name + ": no answer", 0};
      if (*value != number(expected.value)) {
        return {ModbusOutcome::kRejected,
                expected.reg.name + " reads " + std::to_string(*value) + ", expected " +
                    std::to_string(number(expected.value)),
                0};
      }
    }
    return {};
  }

  SequenceResult run_step(const std::shared_ptr<const BranchStep>& step) {
    const auto holds = look(step->condition);
    if (!holds) return {ModbusOutcome::kUnknown, "branch: the drive does not answer", 0};
    return run(*holds ? step->then : step->otherwise);
  }

  std::optional<bool> look(const DriveCondition& condition) {
    return condition.holds([this](const DriveRegister& reg) { return read_register(link_, reg, priority_, stop_); });
  }

  static std::string names(const DriveCondition& condition) {
    std::string all;
    for (const DriveRegister& reg : condition.registers()) all += (all.empty() ? "" : ", ") + reg.name;
    return all;
  }

  ModbusLink& link_;
  const DriveValues& values_;
  ModbusPriority priority_;
  std::stop_token stop_;
};

}  // namespace

SequenceResult run_sequence(ModbusLink& link, const DriveSequence& sequence, const DriveValues& values,
                            ModbusPriority priority, std::stop_token stop, std::size_t first) {
  return Runner(link, values, priority, std::move(stop)).run(sequence, first);
}

std::optional<std::int64_t> read_register(ModbusLink& link, const DriveRegister& reg, ModbusPriority priority,
                                          std::stop_token stop, std::string* why) {
  const ModbusReply reply = link.read(reg.table, reg.address, reg.words(), priority, std::move(stop));
  if (reply.outcome != ModbusOutcome::kOk) {
    if (why != nullptr) *why = reply.error;
    return std::nullopt;
  }
  return decode(reg, reply.values.data());
}

}  // namespace fvd
