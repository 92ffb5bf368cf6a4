#pragma once

/// A recorded stack in the place of camera and stage: the scan runs as on the machine, on slices from disk.

#include <memory>

#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// A camera that delivers the slice where the stage opened with the same replay_dir stands; each trigger one complete
/// frame at once. Exposure and gain are accepted and have no effect; size and pixel format must be the recording's.
/// Every result is stamped simulated: it is no measurement of the part in the machine.
/// Throws Error kBadConfig without replay_dir, kBadInput for a recording that cannot be used.
/// A slice that turns out unreadable makes trigger() throw kBadInput with the file's name.
[[nodiscard]] std::unique_ptr<Camera> open_replay_camera(const CameraConfig& config);

/// A stage that is at rest, homed, and jumps to the recorded slice nearest to its target; its measured position is that
/// slice's z. A target further from every slice than the settle window fails with kStagePosition. Travel: the recorded
/// range plus half a step, inside the configured limits. No take-up.
/// Throws Error kBadConfig without replay_dir, kBadInput for unusable heights.
[[nodiscard]] std::unique_ptr<Axis> open_replay_stage(const StageConfig& config);

}  // namespace fvd
