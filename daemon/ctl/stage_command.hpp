#pragma once

/// The commands `fvdctl stage check`, `accuracy` and `stop`: a drive at the end of a line, without the daemon.

#include <filesystem>
#include <string>

#include "core/scan/stage_run.hpp"
#include "daemon/ctl/fvdctl.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd::ctl {

struct StageArguments {
  StageConfig stage;
  std::string gcs_axis;           ///< empty = a Modbus drive by its profile
  std::string tcp;                ///< HOST or HOST:PORT; empty = the serial port of `stage`
  int response_timeout_ms = 200;  ///< 10..10000
  bool json = false;
  bool home = false;
  StageRunPlan plan;
  double lead_um = 0.0;  ///< lead of the screw; 0 = the profile's
  std::filesystem::path out;
  std::filesystem::path config_file = "/etc/fvd/fvd.json";  ///< of stop
};

/// Reads registers and writes none. kExitOk if the drive fits its profile, kExitBadData if it disagrees.
[[nodiscard]] int run_stage_check(StageArguments arguments, const Terminal& terminal);

/// Moves the stage and writes stage_accuracy.json, .csv and .png into a new folder `out`.
[[nodiscard]] int run_stage_accuracy(StageArguments arguments, const Terminal& terminal);

/// Stops the axis of a station that nobody operates any more, as after a crash of the daemon, and measures its
/// standstill. config_file: the daemon's. kExitOk if it stands still, or if there is none (driver replay); kExitConfig
/// if the file is refused. Throws Error kStageTaken (nothing is sent while another program has the drive),
/// kStageDisconnected, kStagePosition.
[[nodiscard]] int run_stage_stop(const std::filesystem::path& config_file, const Terminal& terminal);

}  // namespace fvd::ctl
