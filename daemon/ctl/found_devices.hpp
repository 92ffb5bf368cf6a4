#pragma once

/// What was found on networks and lines, as lines for people and as JSON.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "drivers/gige/found_camera.hpp"
#include "drivers/modbus/unit_scan.hpp"

namespace fvd::ctl {

struct FoundLine {
  std::string line;  ///< "127.0.0.1:502", "/dev/ttyUSB0 115200 8E1"
  std::vector<FoundUnit> units;
  std::string problem;  ///< why it could not be asked; empty = it was
};

struct FoundDevices {
  std::vector<FoundCamera> cameras;
  std::vector<std::string> serial_ports;
  std::vector<FoundLine> lines;
  std::vector<std::string> problems;
};

[[nodiscard]] std::string line_text(const ModbusLinkConfig& line);

/// One line without its end: who it is, where, who controls it, whether its subnet fits.
[[nodiscard]] std::string camera_text(const FoundCamera& camera);

[[nodiscard]] std::string to_text(const FoundDevices& found);
[[nodiscard]] nlohmann::ordered_json to_json(const FoundDevices& found);

}  // namespace fvd::ctl
