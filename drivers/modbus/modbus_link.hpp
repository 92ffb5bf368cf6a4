#pragma once

/// A Modbus connection that can be trusted: one thread owns it, every outcome is one of three, and nothing that may
/// already have been executed is blindly repeated.

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fvd {

struct ModbusLinkConfig {
  std::string host = "127.0.0.1";
  int port = 502;
  int unit = 1;
  std::chrono::milliseconds response_timeout{200};
};

enum class ModbusOutcome {
  kOk,
  kRejected,  ///< the device answered with an exception: surely not executed, the link is fine
  kUnknown,   ///< no usable answer: may or may not have been executed
};

enum class ModbusPriority { kNormal, kUrgent };

struct ModbusReply {
  ModbusOutcome outcome = ModbusOutcome::kUnknown;
  std::string error;                  ///< empty if kOk
  std::vector<std::uint16_t> values;  ///< of a read that is kOk
  /// Middle of the transaction that succeeded: the best guess of when the device sampled its registers.
  std::chrono::steady_clock::time_point sampled{};
};

struct ModbusLinkStats {
  std::uint64_t transactions = 0;
  std::uint64_t retries = 0;
  std::uint64_t unknown = 0;
  std::uint64_t rejected = 0;
  std::uint64_t reconnects = 0;
  double latency_p50_us = 0.0;  ///< of the last 1024 transactions that were answered
  double latency_p99_us = 0.0;
  double latency_max_us = 0.0;
};

/// Modbus TCP through libmodbus with its own error recovery off: after any doubt the socket is replaced, the only sure
/// way to get rid of a late reply. Reads are tried up to three times, writes once. Urgent requests go ahead of all
/// others, between two attempts of a read too; so an urgent request waits for one response timeout at most. context:
/// thread-safe; calls block for their own transaction.
class ModbusLink {
 public:
  /// Connects. Throws Error kStageDisconnected naming the address and the reason.
  explicit ModbusLink(const ModbusLinkConfig& config);
  ~ModbusLink();
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;

  /// Reads holding registers; count 1..125, address a PDU address.
  [[nodiscard]] ModbusReply read(int address, int count, ModbusPriority priority = ModbusPriority::kNormal);

  /// Writes 1..123 holding registers in one frame (FC 16).
  [[nodiscard]] ModbusReply write(int address, std::span<const std::uint16_t> values,
                                  ModbusPriority priority = ModbusPriority::kNormal);

  [[nodiscard]] ModbusLinkStats stats() const;
  /// "host:port unit n".
  [[nodiscard]] std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
