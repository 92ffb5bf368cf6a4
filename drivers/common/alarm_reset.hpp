#pragma once

/// The end of a drive's alarm.

#include <stop_token>

#include "drivers/common/axis_poller.hpp"
#include "drivers/common/axis_port.hpp"

namespace fvd {

/// Tells the drive to end its alarm and returns when the samples say that it has; no effect without an alarm. Moves
/// nothing. Throws Error kStageAlarm (it stands 2 s later), kStageDisconnected, kAborted.
/// context: one thread at a time, as the axis.
void end_alarm(AxisPort& port, AxisPoller& poller, const std::stop_token& stop);

}  // namespace fvd
