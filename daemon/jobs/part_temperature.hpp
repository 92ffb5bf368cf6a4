#pragma once

/// The temperature that a result tells: the job's own, else the one in the configured file.

#include <chrono>
#include <optional>
#include <string>

#include "daemon/config/config.hpp"
#include "daemon/result/result_data.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

struct TemperatureReading {
  std::optional<Temperature> temperature;
  std::string problem;  ///< why there is none, and what to do
};

/// What the file says. source.file: not empty. Its age is that of its last change; of a file in sysfs it is 0, for the
/// kernel measures when it is read. Only regular files are read, and only their first bytes: a pipe would wait.
/// Throws nothing.
[[nodiscard]] TemperatureReading read_temperature(const TemperatureConfig& source,
                                                  std::chrono::system_clock::time_point now);

/// Fills result.temperature, or adds the warning temperature_unknown where the file that is to tell it does not.
/// context: any thread; waits for the file alone.
void note_temperature(const JobRequest& request, const TemperatureConfig& source, ResultData& result);

}  // namespace fvd
