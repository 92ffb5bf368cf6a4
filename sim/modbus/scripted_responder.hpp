#pragma once

/// Executes requests as a script of faults wants it: the part of faults that is the same on every line.

#include <chrono>
#include <cstdint>
#include <span>

#include "sim/modbus/drive_faults.hpp"
#include "sim/modbus/fault_script.hpp"
#include "sim/modbus/modbus_responder.hpp"

namespace fvd::sim {

/// What goes back on the line, and how.
struct LineAnswer {
  ModbusBytes pdu;                      ///< empty = nothing goes back
  std::chrono::milliseconds late{0};    ///< leaves so much later
  bool wrong_check = false;             ///< with a checksum, or transaction number, that is wrong
  bool truncated = false;               ///< only its first half
  bool cut = false;                     ///< the line is cut instead ...
  std::chrono::milliseconds outage{0};  ///< ... and stays so
};

/// context: one thread.
class ScriptedResponder {
 public:
  /// Both pointers may be null: then nothing befalls the line, or the drive. All outlive the responder.
  ScriptedResponder(RegisterBank& bank, FaultScript* script, DriveFaults* drive)
      : bank_(bank), script_(script), drive_(drive) {}

  [[nodiscard]] LineAnswer answer(std::span<const std::uint8_t> request);
  void idle() { bank_.idle(); }

 private:
  void befall_drive(const FaultStep& step);

  RegisterBank& bank_;
  FaultScript* script_;
  DriveFaults* drive_;
};

}  // namespace fvd::sim
