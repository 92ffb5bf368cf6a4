#pragma once

/// Executes Modbus requests of either line (Modbus Application Protocol V1.1b3, section 6).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/modbus/register_bank.hpp"

namespace fvd::sim {

using ModbusBytes = std::vector<std::uint8_t>;

/// The reply PDU to a request PDU (function code first, no unit, no checksum): function codes 1, 2 (the same coils),
/// 3, 4 (the same registers), 5, 6, 8 (return the query only), 15, 16, 23 and, of a bank that can identify itself,
/// 43/14; exception 1 for others, 3 for a malformed request, else what the bank says. Function code 23 writes before it
/// reads and writes nothing if its read is malformed. An empty request gives an empty reply. Throws nothing of its own.
/// context: as the bank's.
[[nodiscard]] ModbusBytes respond(RegisterBank& bank, std::span<const std::uint8_t> request);

/// Addresses that a request PDU reads and writes, as far as they can be found without executing it.
struct RequestSummary {
  struct Range {
    int first = 0;
    int count = 0;
    [[nodiscard]] bool contains(int address) const { return address >= first && address < first + count; }
  };
  bool writes = false;  ///< function codes 5, 6, 15, 16, 23
  Range read;           ///< count 0 = reads nothing
  Range written;
  [[nodiscard]] bool contains(int address) const { return read.contains(address) || written.contains(address); }
};
[[nodiscard]] RequestSummary summary_of(std::span<const std::uint8_t> request);

/// Length in bytes of a serial request frame with unit and checksum, from its first bytes: 0 = more bytes are needed,
/// -1 = unknown function code, only silence ends the frame.
[[nodiscard]] int rtu_frame_length(std::span<const std::uint8_t> frame);

/// CRC-16 of Modbus serial line (V1.02, 6.2.2): its low byte goes first.
[[nodiscard]] std::uint16_t modbus_crc(std::span<const std::uint8_t> bytes);

}  // namespace fvd::sim
