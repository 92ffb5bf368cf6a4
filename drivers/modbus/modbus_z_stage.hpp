#pragma once

/// A stepper drive on Modbus as a Z stage, driven by its profile.

#include <memory>

#include "core/hw/z_stage.hpp"
#include "drivers/driver_config.hpp"

namespace fvd {

/// Connects, reads the drive's state once, and keeps sampling it: fast while something moves or is measured, slowly
/// else. A drive that stops answering makes every call throw kStageDisconnected within about a second; the object is
/// dead then. Throws Error kBadConfig (profile), kStageDisconnected.
[[nodiscard]] std::unique_ptr<ZStage> open_modbus_stage(const StageConfig& config);

}  // namespace fvd
