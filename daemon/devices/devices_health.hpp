#pragma once

/// How well devices and lines do, for people and programs that watch a station.

#include <optional>
#include <vector>

#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"

namespace fvd {

struct DeviceReport {
  bool open = false;
  int openings = 0;  ///< since the daemon's start; more than one: it was lost
};

/// Where an axis may be sent, its soft limits.
struct StageReach {
  Micrometers min;
  Micrometers max;
};

/// Counters are those since a device was opened last; of one that is not open they are 0.
struct DevicesHealth {
  DeviceReport camera;
  DeviceReport stage;
  CameraHealth frames{};
  std::optional<StageLinkStats> link{};          ///< nothing for an axis without a line
  std::vector<StageTemperature> temperatures{};  ///< that the drive tells
  std::optional<Micrometers> position{};         ///< where the stage was seen last; nothing if that is not known
  std::optional<StageReach> reach{};             ///< nothing while the axis is not open
};

}  // namespace fvd
