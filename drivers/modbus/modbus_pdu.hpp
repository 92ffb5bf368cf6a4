#pragma once

/// Requests and answers of Modbus as bytes, without what a line puts around them (Modbus Application Protocol V1.1b3).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fvd {

enum class ModbusTable { kHolding, kInput, kCoil, kDiscrete };

struct ModbusRequest {
  ModbusTable table = ModbusTable::kHolding;
  int address = 0;
  int read_count = 0;                  ///< > 0: a read
  std::vector<std::uint16_t> written;  ///< else a write; bits as 0 and 1
  bool single = false;                 ///< FC 5 or 6 instead of 15 or 16, for one value

  [[nodiscard]] bool writes() const noexcept { return read_count == 0; }
};

/// Function code first.
[[nodiscard]] std::vector<std::uint8_t> request_pdu(const ModbusRequest& request);

enum class PduAnswer {
  kOk,
  kException,  ///< the device refused: not executed
  kLater,      ///< exception 5, 6, 0x0A or 0x0B: still at it, busy, or a gateway has nothing from it; executed or not
  kNone,       ///< no answer to this request
};

/// What the answer, function code first, says to the request, whose PDU is `sent`. Fills `values` of a read that is
/// kOk, else `error`.
[[nodiscard]] PduAnswer judge_answer(const ModbusRequest& request, std::span<const std::uint8_t> sent,
                                     std::span<const std::uint8_t> answer, std::vector<std::uint16_t>& values,
                                     std::string& error);

/// "exception 6: busy".
[[nodiscard]] std::string exception_text(int code);

}  // namespace fvd
