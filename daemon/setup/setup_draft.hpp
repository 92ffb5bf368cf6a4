#pragma once

/// What was decided so far. Copied at every step, so that an answer can be taken back.

#include <optional>
#include <utility>

#include "core/hw/camera.hpp"
#include "drivers/registry/driver_table.hpp"

namespace fvd {

/// Range of the trial scan, um.
struct TrialRange {
  double start_um = 0.0;
  double step_um = 5.0;  ///< > 0
  int slices = 0;        ///< >= 3
};

struct SetupDraft {
  DeviceConfigs devices;
  std::optional<Micrometers> upper_limit;      ///< taught; in force once the lower one is
  CameraSettings picture;                      ///< exposure and format
  std::optional<std::pair<int, int>> seen_px;  ///< width and height of the picture seen in this step; none = none was
  std::optional<double> pixel_pitch_um;        ///< absent = nobody measured it
  std::optional<double> focus_um;              ///< z at which the surface was seen sharply
  std::optional<TrialRange> trial;             ///< of the last scan that succeeded
};

}  // namespace fvd
