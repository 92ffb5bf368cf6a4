#pragma once

/// A Modbus RTU slave on a pseudo-terminal (Modbus over Serial Line V1.02), as slow as a real bus and with its faults.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "sim/modbus/drive_faults.hpp"
#include "sim/modbus/fault_script.hpp"
#include "sim/modbus/register_bank.hpp"

namespace fvd::sim {

/// The times of a transaction: characters of 11 bits both ways, the drive's turnaround, the silence before the next
/// request, and the adapter that hands bytes over at ticks of its latency timer.
struct LineTiming {
  int baud = 115200;                              ///< 1200..4000000; the client's setting is ignored
  std::chrono::microseconds turnaround{0};        ///< end of request to start of reply; real drives 4 ms
  std::chrono::microseconds usb_latency{0};       ///< adapter's timer, 0 = none; real adapters 1 or 16 ms
  std::chrono::microseconds inter_frame{1750};    ///< silence that must precede a request
  std::chrono::microseconds frame_silence{1750};  ///< silence that ends a frame, if longer than 3.5 characters
};

struct ModbusRtuOptions {
  std::filesystem::path link{};  ///< symbolic link to the slave, empty = none; an old link there is replaced
  int unit = 1;                  ///< 1..247; broadcasts to 0 are executed and not answered, others ignored
  LineTiming timing{};
  FaultScript* faults = nullptr;  ///< null = no faults; outlives the server
  DriveFaults* drive = nullptr;   ///< the drive that drive faults of the script strike; null = they have no effect
};

/// Serves the function codes of respond() on one thread. The function code determines the end of a frame; a frame of an
/// unknown function code ends by silence. After a wrong checksum all bytes up to the next silence are discarded,
/// without an answer. Faults of a script on this line: kWrongCrc sends a wrong checksum, kTruncatedFrame the first half
/// of the reply; kLinkCut discards all input while it lasts.
///
/// Clients may open and close the slave as they like; bytes that none has read wait for the next one.
class ModbusRtuServer {
 public:
  /// Throws Error kBadConfig if no pseudo-terminal or no link can be had. The bank outlives the server.
  ModbusRtuServer(RegisterBank& bank, const ModbusRtuOptions& options);
  ~ModbusRtuServer();

  /// What a client opens: the link if there is one, else the slave, /dev/pts/N.
  [[nodiscard]] const std::filesystem::path& path() const noexcept;
  /// Valid requests to this unit or to all. context: any thread, as set_mute.
  [[nodiscard]] std::uint64_t requests() const noexcept;
  void set_mute(bool mute);  ///< takes requests, executes nothing, answers nothing

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd::sim
