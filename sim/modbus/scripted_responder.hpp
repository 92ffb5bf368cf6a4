#pragma once

/// Executes requests with the faults of a script: the part that is the same on every line.

#include <chrono>
#include <cstdint>
#include <span>

#include "sim/modbus/drive_faults.hpp"
#include "sim/modbus/fault_script.hpp"
#include "sim/modbus/modbus_responder.hpp"

namespace fvd::sim {

/// The reply to a request, and the fault with which it is sent.
struct LineAnswer {
  ModbusBytes pdu;                      ///< empty = nothing goes back
  std::chrono::milliseconds late{0};    ///< delay of the reply
  bool wrong_check = false;             ///< send a wrong checksum or transaction number
  bool truncated = false;               ///< send only the first half
  bool cut = false;                     ///< cut the line instead of replying
  std::chrono::milliseconds outage{0};  ///< time for which the line stays cut
};

/// context: one thread.
class ScriptedResponder {
 public:
  /// script, drive: null = no faults of the line, or of the drive. All outlive the responder.
  ScriptedResponder(RegisterBank& bank, FaultScript* script, DriveFaults* drive)
      : bank_(bank), script_(script), drive_(drive) {}

  [[nodiscard]] LineAnswer answer(std::span<const std::uint8_t> request);
  void idle() { bank_.idle(); }

 private:
  void befall_drive(const FaultStep& step);
  void write_as_another_master(const FaultStep& step);

  RegisterBank& bank_;
  FaultScript* script_;
  DriveFaults* drive_;
};

}  // namespace fvd::sim
