#pragma once

/// One axis of a controller by Physik Instrumente that speaks GCS 2.0.

#include <memory>

#include "core/hw/axis.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// Connects and finds the axis; else as make_axis. Throws Error kStageDisconnected (no answer, no such axis), and as
/// make_axis does.
[[nodiscard]] std::unique_ptr<Axis> open_gcs_stage(const StageConfig& config);

}  // namespace fvd
