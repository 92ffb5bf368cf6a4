#pragma once

/// Jobs and machine states as flat JSON objects in a fixed order of keys, as PLCs search them.

#include <nlohmann/json.hpp>

#include "daemon/jobs/services.hpp"

namespace fvd {

/// At most about 500 bytes.
[[nodiscard]] nlohmann::ordered_json job_status_json(const JobStatus& job);
/// hb: counts up once a second.
[[nodiscard]] nlohmann::ordered_json machine_status_json(const MachineStatus& machine, std::int64_t hb);
/// At most 440 bytes: the main values of a result, picked from result.json.
/// null for what is not observable or not known yet; all counts 0 before the first scan.
[[nodiscard]] nlohmann::ordered_json stage_history_json(const std::optional<StepHistorySummary>& history);

[[nodiscard]] nlohmann::ordered_json compact_result_json(const JobStatus& job, const std::string& result_text);
/// At most 1400 bytes: the whole result.json without what is long, and where the files are.
[[nodiscard]] nlohmann::ordered_json full_result_json(const JobStatus& job, const std::string& result_text,
                                                      const std::string& directory);

}  // namespace fvd
