#pragma once

/// Sequences of a drive profile - enable, home, move, stop - and their execution on a link.

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "drivers/modbus/drive_register.hpp"

namespace fvd {

/// What a sequence may put in place of a number.
enum class DriveVariable { kTarget, kSpeed, kAcceleration };
using DriveValue = std::variant<std::int64_t, DriveVariable>;

struct RegisterWrite {
  DriveRegister reg;
  DriveValue value;
};

/// Registers or coils that follow each other, written in one frame: all of them or none.
struct WriteStep {
  std::vector<RegisterWrite> writes;
  bool repeatable = false;  ///< does no harm twice: sent again while the drive is busy or does not answer
};
/// Sets bits, holds them, clears them: an edge for drives that start on one.
struct PulseStep {
  DriveRegister reg;
  std::uint32_t mask = 0;
  std::chrono::milliseconds on{0};
  std::chrono::milliseconds off{0};
};
/// Read, change some bits, write: for control words shared by several functions. Not atomic on the drive.
struct ModifyStep {
  DriveRegister reg;
  std::uint32_t set = 0;
  std::uint32_t clear = 0;
};
struct WaitStep {
  DriveCondition condition;
  std::chrono::milliseconds timeout{0};
};
struct DelayStep {
  std::chrono::milliseconds time{0};
};
/// Reads registers back and wants the values that stand here.
struct ExpectStep {
  std::vector<RegisterWrite> values;
};
struct BranchStep;
using DriveStep =
    std::variant<WriteStep, PulseStep, ModifyStep, WaitStep, DelayStep, ExpectStep, std::shared_ptr<const BranchStep>>;
using DriveSequence = std::vector<DriveStep>;
struct BranchStep {
  DriveCondition condition;
  DriveSequence then;
  DriveSequence otherwise;
};

struct DriveValues {
  std::int64_t target = 0;
  std::int64_t speed = 0;
  std::int64_t acceleration = 0;
};

/// How a sequence ended. kUnknown: a step got no usable answer; what was sent may or may not have been executed.
struct SequenceResult {
  ModbusOutcome outcome = ModbusOutcome::kOk;
  std::string error;        ///< empty if kOk; else which step and why
  std::size_t step = 0;     ///< that did not end with kOk, 0-based; a branch counts as one
  bool later = false;       ///< of kUnknown: the drive was busy, the line is sound
  bool repeatable = false;  ///< of kUnknown: the step does no harm twice
};

/// Runs the steps in order up to the first that is not ok. A write is sent once; a repeatable one again while the drive
/// is busy, and twice more where no answer comes; an urgent one again while the drive is busy. A change of bits is read
/// and written anew while the drive is busy. A wait that runs out and an expectation that is not met are kRejected.
/// first: of the steps to run. A stop request ends waits, delays and the patience with a busy drive with kUnknown; the
/// bits of a pulse are cleared all the same. context: blocks.
[[nodiscard]] SequenceResult run_sequence(ModbusLink& link, const DriveSequence& sequence, const DriveValues& values,
                                          ModbusPriority priority, std::stop_token stop, std::size_t first = 0);

/// One register, read in a transaction of its own; nothing if it could not be read, and then the reason in `why`. A
/// stop request ends the patience with a busy drive.
[[nodiscard]] std::optional<std::int64_t> read_register(ModbusLink& link, const DriveRegister& reg,
                                                        ModbusPriority priority = ModbusPriority::kNormal,
                                                        std::stop_token stop = {}, std::string* why = nullptr);

}  // namespace fvd
