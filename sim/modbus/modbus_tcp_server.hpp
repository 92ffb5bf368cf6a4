#pragma once

/// A Modbus TCP server over a bank of registers (Modbus Messaging on TCP/IP Implementation Guide V1.0b), with faults
/// that real lines have.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "sim/modbus/drive_faults.hpp"
#include "sim/modbus/fault_script.hpp"
#include "sim/modbus/register_bank.hpp"

namespace fvd::sim {

struct ModbusTcpOptions {
  std::string address = "127.0.0.1";
  int port = 0;                   ///< 0 = any free port
  int unit = 1;                   ///< requests for other units get no answer, as on a real bus
  FaultScript* faults = nullptr;  ///< null = a script of the server's own; outlives the server
  DriveFaults* drive = nullptr;   ///< the drive that drive faults of the script strike; null = they have no effect
};

/// Serves the function codes of respond() to several clients on one thread. Faults of a script on this line: kWrongCrc
/// sends the transaction number of another request, kTruncatedFrame the first half of the reply and leaves the
/// connection open; kLinkCut closes every connection, and executes requests of new ones only when it is over.
class ModbusTcpServer {
 public:
  /// Listens. Throws Error kBadConfig if the address cannot be bound. The bank outlives the server.
  ModbusTcpServer(RegisterBank& bank, const ModbusTcpOptions& options);
  ~ModbusTcpServer();

  [[nodiscard]] int port() const noexcept;
  [[nodiscard]] std::uint64_t requests() const noexcept;

  // Faults. context: any thread.
  void set_mute(bool mute);  ///< takes requests, executes nothing, answers nothing
  // Steps appended to the server's script:
  void delay_replies(int count, std::chrono::milliseconds delay);  ///< the next `count` replies come late
  void lose_write_replies(int count);  ///< the next `count` writes are executed but not answered
  void lose_writes(int count);         ///< the next `count` writes are not executed and not answered

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd::sim
