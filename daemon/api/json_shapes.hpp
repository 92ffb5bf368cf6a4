#pragma once

/// Jobs, machine states and results as flat JSON objects in a fixed order of keys, as PLCs search them; each with its
/// description.

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// At most about 500 bytes.
[[nodiscard]] nlohmann::ordered_json job_status_json(const JobStatus& job);
void describe_job_status(Fields& fields);

/// The client's newest sequence number, 0 = none.
[[nodiscard]] std::int64_t newest_seq(const MachineStatus& machine, const std::string& client);
/// client: whose newest_seq is told. hb: counts up once a second.
[[nodiscard]] nlohmann::ordered_json machine_status_json(const MachineStatus& machine, const std::string& client,
                                                         std::int64_t hb);
void describe_machine_status(Fields& fields);

/// The main values of a result, picked from the text of result.json; at most 512 bytes as a reply; with an
/// evaluation its verdict and values in their place, at most 440 bytes.
[[nodiscard]] nlohmann::ordered_json compact_result_json(const JobStatus& job, const std::string& result_text);
/// The whole result.json without what is long, and where the files are; at most 2560 bytes as a reply, and
/// the warnings.
[[nodiscard]] nlohmann::ordered_json full_result_json(const JobStatus& job, const std::string& result_text,
                                                      const std::string& directory);
/// All of result.json under the key "result", of any length.
[[nodiscard]] nlohmann::ordered_json complete_result_json(const JobStatus& job, const std::string& result_text,
                                                          const std::string& directory);
/// Of all three.
void describe_result(Fields& fields);
/// Of a compact result, or of none.
void describe_next_result(Fields& fields);

/// null for what is not observable or not known yet; all counts 0 before the first scan.
[[nodiscard]] nlohmann::ordered_json stage_history_json(const std::optional<StepHistorySummary>& history);
void describe_stage_history(Fields& fields);

}  // namespace fvd
