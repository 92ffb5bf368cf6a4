#pragma once

/// The devices of a station by kind, and the drivers of each kind by name, one row each: what the configuration says to
/// them, what is checked before, how they are opened.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "config/fields.hpp"
#include "config/problem.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// Lights have no rows yet.
enum class DeviceKind { kCamera, kAxis, kLight };

template <typename Config, typename Device>
struct DriverRow {
  DeviceKind kind;
  const char* name;     ///< in the key "driver"
  const char* meaning;  ///< one line
  /// The keys that only this driver reads. Files that hold another driver's keys are read all the same.
  void (*describe)(Config&, Fields&);
  /// What the range of a single key cannot say. Throws nothing, touches no device.
  void (*check)(const Config&, Problems&);
  /// Throws as the driver says.
  std::unique_ptr<Device> (*open)(const Config&);
  bool locked = false;  ///< takes the lock of the drive (drive_lock.hpp), unless the configuration brings it
};

using CameraDriver = DriverRow<CameraConfig, Camera>;
using AxisDriver = DriverRow<StageConfig, Axis>;
[[nodiscard]] const std::vector<CameraDriver>& camera_drivers();
[[nodiscard]] const std::vector<AxisDriver>& axis_drivers();

/// One block of the configuration per kind.
struct DeviceConfigs {
  CameraConfig camera;
  StageConfig stage;
};

/// How each device is opened; throws as open_camera() and open_stage() do.
struct DeviceOpeners {
  std::function<std::unique_ptr<Camera>()> camera;
  std::function<std::unique_ptr<Axis>()> axis;
};

/// Each block: the driver, the keys that all drivers of the kind share, and each driver's own.
void describe(DeviceConfigs& devices, Fields& fields);
void describe(StageConfig& config, Fields& fields);

/// What the chosen drivers ask for beyond ranges, with pointers that begin at the root of the configuration. read: the
/// problems of reading it; a driver that cannot be known from it is not asked.
[[nodiscard]] Problems check_devices(const DeviceConfigs& devices, const Problems& read);
void check_driver(const StageConfig& config, Problems& problems);

/// The openers own a copy of the configuration. That of the axis holds the drive's lock from the first opening on, as
/// long as it lives: while a lost drive is away, no other program of the machine takes it.
[[nodiscard]] DeviceOpeners openers_of(const DeviceConfigs& devices);

/// Opens the camera. Throws Error kBadConfig for an unknown driver (the message lists the known ones), else what the
/// driver throws.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const CameraConfig& config);
/// Connects the stage. Throws likewise.
[[nodiscard]] std::unique_ptr<Axis> open_stage(const StageConfig& config);

}  // namespace fvd
