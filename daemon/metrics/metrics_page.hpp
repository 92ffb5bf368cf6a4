#pragma once

/// The machine as numbers for Prometheus.

#include <string>

#include "daemon/jobs/services.hpp"

namespace fvd {

/// The text format of Prometheus. Names and units follow its conventions: fvd_, base units, _total for counters, which
/// begin anew when the daemon starts or a device is opened. No label has a part, a job or a client: at most 200 series.
[[nodiscard]] std::string metrics_text(const MachineStatus& machine);

/// For /healthz: nothing if the machine can measure or does; else why not, in one line.
[[nodiscard]] std::optional<std::string> why_unhealthy(const MachineStatus& machine);

}  // namespace fvd
