#pragma once

/// The log's way to the alarms.

#include <memory>

#include <spdlog/common.h>

#include "daemon/jobs/alarm_log.hpp"

namespace fvd {

/// Notes lines of level warning and above, whatever the pattern, but for those of refused calls, which callers make as
/// many as they like of. context: thread-safe.
[[nodiscard]] spdlog::sink_ptr alarm_sink(std::shared_ptr<AlarmLog> alarms);

}  // namespace fvd
