#pragma once

/// Scripts of faults as JSON: a list of steps.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/camera/camera_fault_script.hpp"
#include "sim/modbus/fault_script.hpp"

namespace fvd::sim {

/// [ { "on": "write", "after": 2, "address": 102, "count": 1, "fault": "late_reply", "delay_ms": 300 }, ... ]
///
/// Only "fault" must be given; meaning and ranges are FaultStep's, delays at most 600000 ms. Throws Error kBadConfig
/// with every problem and where it stands, "/3/delay_ms".
[[nodiscard]] std::vector<FaultStep> read_fault_steps(std::string_view json_text, const std::string& source);
/// Throws Error kBadInput too, if the file cannot be read.
[[nodiscard]] std::vector<FaultStep> load_fault_steps(const std::filesystem::path& file);

/// [ { "fault": "late_frame", "on": "frame", "after": 3, "count": 1, "delay_ms": 400, "value": 0, "step_ms": 0 }, ... ]
///
/// Likewise with CameraFaultStep; "on" (command, trigger or frame) only for what strikes anywhere. Throws as above.
[[nodiscard]] std::vector<CameraFaultStep> read_camera_fault_steps(std::string_view json_text,
                                                                   const std::string& source);
[[nodiscard]] std::vector<CameraFaultStep> load_camera_fault_steps(const std::filesystem::path& file);

}  // namespace fvd::sim
