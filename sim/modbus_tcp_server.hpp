#pragma once

/// A Modbus TCP server over a bank of holding registers (Modbus Messaging on TCP/IP Implementation Guide V1.0b), with
/// faults that real lines have.

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace fvd::sim {

/// Modbus exception codes (Modbus Application Protocol V1.1b3, section 7); kNone = no exception.
enum class ModbusException : std::uint8_t { kNone = 0, kIllegalFunction = 1, kIllegalAddress = 2, kIllegalValue = 3 };

/// Addresses are PDU addresses (0-based). context: the server's thread.
class RegisterBank {
 public:
  virtual ~RegisterBank() = default;
  [[nodiscard]] virtual ModbusException read(int address, std::span<std::uint16_t> values) = 0;
  [[nodiscard]] virtual ModbusException write(int address, std::span<const std::uint16_t> values) = 0;
};

struct ModbusTcpOptions {
  std::string address = "127.0.0.1";
  int port = 0;  ///< 0 = any free port
  int unit = 1;  ///< requests for other units get no answer, as on a real bus
};

/// Function codes 3, 6, 16 and 23, several clients, one thread.
class ModbusTcpServer {
 public:
  /// Listens. Throws Error kBadConfig if the address cannot be bound. The bank outlives the server.
  ModbusTcpServer(RegisterBank& bank, const ModbusTcpOptions& options);
  ~ModbusTcpServer();

  [[nodiscard]] int port() const noexcept;
  [[nodiscard]] std::uint64_t requests() const noexcept;

  // Faults. context: any thread.
  void set_mute(bool mute);  ///< takes requests, executes nothing, answers nothing
  void delay_replies(int count, std::chrono::milliseconds delay);  ///< the next `count` replies come late
  void lose_write_replies(int count);  ///< the next `count` writes are executed but not answered
  void lose_writes(int count);         ///< the next `count` writes are not executed and not answered

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd::sim
