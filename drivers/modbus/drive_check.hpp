#pragma once

/// Does a drive say what its profile expects? Reads only: nothing is enabled, reset or moved.

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "drivers/modbus/drive_profile.hpp"
#include "drivers/modbus/modbus_link.hpp"

namespace fvd {

struct DriveCheck {
  struct Register {
    std::string name;
    int address = 0;
    std::optional<std::int64_t> value;
    std::string error;  ///< why it has no value
  };
  struct Statement {
    std::string name;  ///< "moving", or an identity's text
    std::optional<bool> holds;
  };

  std::vector<Register> registers;  ///< all that can be read
  std::vector<Statement> identity;
  std::vector<Statement> status;
  std::optional<double> position_um;  ///< nothing where its register could not be read
  std::string alarm;  ///< empty without one; whether there is one, the statement "alarm" of status tells
  std::vector<StageTemperature> temperatures;
  std::vector<std::string> disagreements;  ///< what the drive says otherwise than the profile; empty = it fits
  std::vector<std::string> doubts;         ///< to look at; they keep nothing from moving
  ModbusLinkStats link;
};

/// Throws Error kStageDisconnected if nothing answers at all, kAborted after a stop request. context: blocks for some
/// dozen transactions.
[[nodiscard]] DriveCheck check_drive(const DriveProfile& profile, ModbusLink& link, std::stop_token stop = {});

}  // namespace fvd
