#pragma once

/// A Modbus connection that can be trusted: one thread owns it, every outcome is one of three, and nothing that may
/// already have been executed is blindly repeated.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "drivers/modbus/modbus_queue.hpp"
#include "drivers/modbus/modbus_transport.hpp"

namespace fvd {

struct ModbusLinkStats {
  std::uint64_t transactions = 0;
  std::uint64_t retries = 0;
  std::uint64_t unknown = 0;
  std::uint64_t rejected = 0;
  std::uint64_t later = 0;  ///< "acknowledge", "busy" and the two of gateways, each of which was no answer
  std::uint64_t reconnects = 0;
  std::uint64_t discarded_bytes = 0;  ///< late, garbled or unasked for
  double latency_p50_us = 0.0;        ///< of the last 1024 transactions that were answered
  double latency_p99_us = 0.0;
  double latency_max_us = 0.0;
};

/// How a write is sent.
struct ModbusWriting {
  bool single = false;      ///< FC 6 or 5, for one value
  bool repeatable = false;  ///< it does no harm twice
};

/// Told of every write before it is sent, and again when it was answered: done is whether it was surely executed.
using WriteObserver = std::function<void(const ModbusRequest&, bool sent, bool done)>;

/// After any doubt the transport is made sure to hold no late reply. Reads are tried up to three times, writes once.
/// Where the device says "later" - still at it, busy, a gateway without an answer - reads and repeatable writes are
/// sent again with growing pauses until the link's patience ends; the caller waits, the line does not.
/// Urgent requests go ahead of all others, between two attempts of a read and into the silence after a doubt too; so an
/// urgent request is sent after one response timeout at most. context: thread-safe; calls block for their own
/// transaction.
class ModbusLink {
 public:
  /// Connects. Throws Error kStageDisconnected naming the address and the reason, kBadConfig as check() does.
  explicit ModbusLink(const ModbusLinkConfig& config);
  ~ModbusLink();
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;

  /// Reads registers, count 1..125, or bits, count 1..2000, as 0 and 1. address: a PDU address.
  [[nodiscard]] ModbusReply read(ModbusTable table, int address, int count,
                                 ModbusPriority priority = ModbusPriority::kNormal, std::stop_token stop = {});

  /// Writes 1..123 holding registers or coils in one frame. A stop request ends the patience.
  [[nodiscard]] ModbusReply write(ModbusTable table, int address, std::span<const std::uint16_t> values,
                                  ModbusPriority priority = ModbusPriority::kNormal, ModbusWriting how = {},
                                  std::stop_token stop = {});

  /// Tries again, with growing pauses, for as long as the reply is "later" and the link's patience lasts. A stop
  /// request ends the patience.
  [[nodiscard]] ModbusReply patiently(const std::function<ModbusReply()>& attempt, const std::stop_token& stop);

  /// Before the first write; called on the writers' threads, and outlives the link.
  void observe_writes(WriteObserver observer);

  [[nodiscard]] ModbusLinkStats stats() const;
  /// "host:port unit n" or "device unit n".
  [[nodiscard]] std::string description() const;
  /// What to look at where nothing comes: of a serial line, or of a connection that was made, on which serial frames
  /// are tried. context: blocks for two response timeouts.
  [[nodiscard]] std::string advice() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
