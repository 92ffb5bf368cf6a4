#pragma once

/// A stepper drive on Modbus as a Z stage, driven by its profile.

#include <memory>

#include "core/hw/axis.hpp"
#include "drivers/common/driver_config.hpp"
#include "drivers/modbus/modbus_transport.hpp"

namespace fvd {

/// The line a configuration describes.
[[nodiscard]] ModbusLinkConfig modbus_link_config(const StageConfig& config);

/// Takes the drive's lock, connects, makes sure that it is the profile's drive, halts it if it moves. Before the first
/// motion it writes the profile's settings, arms the drive's own watchdog where there is one, and enables what is not
/// enabled; before that the drive must agree with its profile as `fvdctl stage check` tells. A drive that
/// stops answering makes every call throw kStageDisconnected within about a second; the object is dead then. Throws
/// Error kBadConfig (profile, line), kStageDisconnected, kStageTaken (another program has the lock), and as make_axis
/// does.
[[nodiscard]] std::unique_ptr<Axis> open_modbus_stage(const StageConfig& config);

}  // namespace fvd
