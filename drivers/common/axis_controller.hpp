#pragma once

/// An Axis on top of a protocol's port: limits, reference, settling, sampling, standstill.

#include <memory>

#include "core/hw/axis.hpp"
#include "drivers/common/axis_port.hpp"
#include "drivers/common/axis_requirements.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// The part of a stage's configuration that no protocol needs to know.
[[nodiscard]] AxisSettings axis_settings(const StageConfig& config);

/// Samples the axis for as long as it lives: fast while something moves or is measured, slowly otherwise. An axis that
/// moves is halted at once; nothing else is written to it before the first motion: then it is enabled, where it is not.
/// Every way out of a motion - arrival, timeout, alarm, lost line, stop
/// request - ends at a standstill that was measured, or in an error that contains "standstill was not confirmed".
/// A controller that stops answering makes every call throw kStageDisconnected; the object is dead then.
/// Throws Error kStageDisconnected, kStageLimit (the controller's own limits are narrower than the configured ones),
/// kStagePosition (it cannot be stopped).
[[nodiscard]] std::unique_ptr<Axis> make_axis(std::unique_ptr<AxisPort> port, const AxisSettings& settings);

}  // namespace fvd
