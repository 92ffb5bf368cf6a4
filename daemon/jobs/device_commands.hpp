#pragma once

/// What may be asked of the devices between two jobs; each becomes the work of a DeviceTask whose result is a JSON
/// text.

#include "core/scan/autofocus.hpp"
#include "daemon/jobs/device_task.hpp"

namespace fvd {

/// One image, by a software trigger, in full: <state_dir>/snaps/<UTC time>.png, 8 or 16 bit, and what its grey levels
/// say. The newest hundred are kept. Throws what the camera throws, kCameraFramesLost, kStorageWrite.
[[nodiscard]] DeviceTask::Work snap_work(const CameraSettings& settings);

/// One image scaled down, as preview_json().
[[nodiscard]] DeviceTask::Work preview_work(const CameraSettings& settings);

/// Looks, and changes the exposure, until 0.1 % of the pixels are brighter than `target` of full scale, 8 looks at
/// most. However it ends, `settings` are put back in force.
[[nodiscard]] DeviceTask::Work exposure_work(const CameraSettings& settings, double target);

/// See autofocus().
[[nodiscard]] DeviceTask::Work autofocus_work(const CameraSettings& settings, const AutofocusPlan& plan);

[[nodiscard]] DeviceTask::Work home_work();
[[nodiscard]] DeviceTask::Work move_work(Micrometers target);

}  // namespace fvd
