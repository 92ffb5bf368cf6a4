#pragma once

/// The commands to the devices between two jobs: each function gives the work of a DeviceTask; the work returns a JSON
/// text.

#include "core/scan/autofocus.hpp"
#include "daemon/jobs/device_task.hpp"

namespace fvd {

/// Takes one image by a software trigger, writes it in full size to <state_dir>/snaps/<UTC time>-<n>.png, 8 or 16 bit,
/// and tells the statistics of its grey levels. The newest hundred files are kept. Throws what the camera throws,
/// kCameraFramesLost, kStorageWrite.
[[nodiscard]] DeviceTask::Work snap_work(const CameraSettings& settings);

/// One image scaled down, as preview_json().
[[nodiscard]] DeviceTask::Work preview_work(const CameraSettings& settings);

/// Takes images, and changes the exposure, until 0.1 % of the pixels are brighter than `target` (0..1) of full scale, 8
/// images at most. However it ends, `settings` are put back in force,
/// except when it is stopped.
[[nodiscard]] DeviceTask::Work exposure_work(const CameraSettings& settings, double target);

/// See autofocus().
[[nodiscard]] DeviceTask::Work autofocus_work(const CameraSettings& settings, const AutofocusPlan& plan);

[[nodiscard]] DeviceTask::Work home_work();
/// Tells the drive to end its alarm: throws Error kStageAlarm while it keeps it, kStageDisconnected.
[[nodiscard]] DeviceTask::Work reset_work();
[[nodiscard]] DeviceTask::Work move_work(Micrometers target);

}  // namespace fvd
