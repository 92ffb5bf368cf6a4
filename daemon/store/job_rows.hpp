#pragma once

/// Rows of the table of jobs, and the ends that they do not have yet.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "daemon/store/database.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

/// Columns in the order in which read_job_row() takes them.
#define FVD_JOB_COLUMNS                                                                                            \
  "job_id, client, seq, part_id, recipe, state, error, error_message, acknowledged, slices_done, slices_planned, " \
  "frames_expected, frames_ok, frames_incomplete, frames_missing, frames_stale, frames_underrun, result_dir, "     \
  "result_json, acquired, temperature_c, files_pending, session, ended_utc, verdict, reason_codes, removed_utc"

[[nodiscard]] StoredJob read_job_row(const Statement& row);
/// The state that a row names; kFailed for a name that nobody knows.
[[nodiscard]] JobState job_state_in_row(const std::string& name);

/// Ends that could not be stored yet, by job_id.
using KeptEnds = std::map<std::string, StoredJob>;

/// The first of the rows, or its job's end that the row does not have yet.
[[nodiscard]] std::optional<JobStatus> first_status(Statement& rows, const KeptEnds& kept);

/// The number in the first column of the first row; 0 without a row.
[[nodiscard]] std::int64_t scalar(const Database& database, const char* sql);

/// "seq 7 of client 'plc'".
[[nodiscard]] std::string number_text(std::int64_t seq, const std::string& client);

/// Throws Error kUnknownJob.
[[nodiscard]] StoredJob job_in(const Database& database, const KeptEnds& kept, const JobKey& key);

/// Writes the end of a job into its row, and the values of its result in place of any before, without a transaction of
/// its own.
void write_end(const Database& database, const StoredJob& end);

}  // namespace fvd
