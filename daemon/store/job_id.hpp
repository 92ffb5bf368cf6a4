#pragma once

/// Names of jobs.

#include <chrono>
#include <cstdint>
#include <string>

namespace fvd {

/// "20261123T142501Z-00017-000042": UTC time, the daemon's start, the job's number in the database; 29 characters while
/// epoch < 1e5 and number < 1e6. Unique in one database through the number, over a lost database through the time.
[[nodiscard]] std::string make_job_id(std::chrono::system_clock::time_point now, std::int64_t epoch,
                                      std::int64_t number);

}  // namespace fvd
