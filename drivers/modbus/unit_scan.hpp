#pragma once

/// Which units answer on a Modbus line. Reads only: one holding register of each unit.

#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "drivers/modbus/modbus_transport.hpp"

namespace fvd {

/// Serial ports of this machine, by their names in /dev/serial/by-id, and those that have none there by ttyUSB, ttyACM
/// and ttyAMA. Nothing is opened.
[[nodiscard]] std::vector<std::string> serial_ports();

struct FoundUnit {
  int unit = 0;
  std::string answer;  ///< "register 0 is 17", or what it refused
};

struct UnitScan {
  ModbusLinkConfig line;  ///< its unit counts for nothing
  int first = 1;          ///< 1..247
  int last = 247;         ///< >= first
};

/// Asks unit by unit for holding register 0. A refusal is an answer too, and so is "busy" to the question and its
/// repetition; what a gateway answers in a unit's place is none. Takes a response timeout for each unit that is
/// silent, on a serial line its quiet time as well. on_unit: called before each. Throws Error kBadConfig as check(),
/// kBadInput for such a range, kStageDisconnected if the line cannot be opened, kAborted after a stop request.
[[nodiscard]] std::vector<FoundUnit> scan_units(const UnitScan& scan, const std::function<void(int unit)>& on_unit,
                                                const std::stop_token& stop);

}  // namespace fvd
