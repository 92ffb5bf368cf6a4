#pragma once

/// Jobs and machine states as flat JSON objects in a fixed order of keys, as PLCs search them; each with its
/// description.

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"
#include "daemon/api/reply_form.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// Of a text for people in a reply, as it is written there.
inline constexpr std::size_t kLongestMessage_bytes = 200;

/// Every key.
[[nodiscard]] nlohmann::ordered_json job_status_json(const JobStatus& job);
/// envelope_bytes: of the reply around it.
[[nodiscard]] nlohmann::ordered_json job_status_reply(const JobStatus& job, const ReplyForm& form,
                                                      std::size_t envelope_bytes);
void describe_job_status(Fields& fields);

/// The client's newest sequence number, 0 = none.
[[nodiscard]] std::int64_t newest_seq(const MachineStatus& machine, const std::string& client);
/// client: whose newest_seq is told. hb: counts up once a second.
[[nodiscard]] nlohmann::ordered_json machine_status_json(const MachineStatus& machine, const std::string& client,
                                                         std::int64_t hb);
[[nodiscard]] nlohmann::ordered_json machine_status_reply(const MachineStatus& machine, const std::string& client,
                                                          std::int64_t hb, const ReplyForm& form,
                                                          std::size_t envelope_bytes);
void describe_machine_status(Fields& fields);

/// The error's code on the wire and its name; 0 and empty = no error.
[[nodiscard]] int code_of(const std::optional<ErrorCode>& error);
[[nodiscard]] nlohmann::ordered_json error_of(const std::optional<ErrorCode>& error);

/// null for what is not observable or not known yet; all counts 0 before the first scan.
[[nodiscard]] nlohmann::ordered_json stage_history_json(const std::optional<StepHistorySummary>& history);
void describe_stage_history(Fields& fields);

}  // namespace fvd
