#include "daemon/store/job_rows.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"

namespace fvd {

JobState job_state_in_row(const std::string& name) {
  constexpr std::array kAll{JobState::kProcessing, JobState::kCompleted, JobState::kAborted, JobState::kFailed};
  for (const JobState state : kAll) {
    if (job_state_name(state) == name) return state;
  }
  return JobState::kFailed;
}

StoredJob read_job_row(const Statement& row) {
  StoredJob job;
  int column = 0;
  const auto text = [&] { return row.text(column++); };
  const auto integer = [&] { return row.integer(column++); };
  const auto count = [&] { return static_cast<std::uint64_t>(integer()); };
  JobStatus& status = job.status;
  status.job_id = text();
  status.request.client = text();
  status.request.seq = integer();
  status.request.part_id = text();
  status.request.recipe = text();
  status.state = job_state_in_row(text());
  if (const std::string name = text(); !name.empty()) status.error = error_from_name(name);
  status.error_message = text();
  status.acknowledged = integer() != 0;
  status.slices_done = static_cast<int>(integer());
  status.slices_planned = static_cast<int>(integer());
  status.frames.expected = count();
  status.frames.ok = count();
  status.frames.incomplete = count();
  status.frames.missing = count();
  status.frames.stale = count();
  status.frames.underrun = count();
  job.result_dir = text();
  job.result_json = text();
  status.acquired = integer() != 0;
  status.request.temperature_c = row.real(column++);
  job.files_pending = integer() != 0;
  status.request.session = text();
  status.ended_utc = text();
  status.verdict = text();
  status.reason_codes = text();
  status.removed_utc = text();
  return job;
}

namespace {

/// The row, or the job's end that the row does not have yet.
StoredJob as_it_stands(const StoredJob& row, const KeptEnds& kept) {
  const auto end = kept.find(row.status.job_id);
  return end == kept.end() ? row : end->second;
}

}  // namespace

std::optional<JobStatus> first_status(Statement& rows, const KeptEnds& kept) {
  if (!rows.step()) return std::nullopt;
  return as_it_stands(read_job_row(rows), kept).status;
}

std::string number_text(std::int64_t seq, const std::string& client) {
  return "seq " + std::to_string(seq) + " of client '" + client + "'";
}

namespace {

std::string key_text(const JobKey& key) {
  if (const auto* id = std::get_if<std::string>(&key)) return "'" + *id + "'";
  const auto& number = std::get<ClientSeq>(key);
  return "with " + number_text(number.seq, number.client);
}

}  // namespace

std::int64_t scalar(const Database& database, const char* sql) {
  Statement query(database, sql);
  return query.step() ? query.integer(0) : 0;
}

StoredJob job_in(const Database& database, const KeptEnds& kept, const JobKey& key) {
  const auto* id = std::get_if<std::string>(&key);
  Statement query(database, id != nullptr ? "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE job_id = ?"
                                          : "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE client = ? AND seq = ?");
  if (id != nullptr) {
    query.bind(*id);
  } else {
    const auto& number = std::get<ClientSeq>(key);
    query.bind(number.client).bind(number.seq);
  }
  if (!query.step()) throw Error(ErrorCode::kUnknownJob, "no job " + key_text(key) + " is known");
  return as_it_stands(read_job_row(query), kept);
}

namespace {

/// SQLite keeps infinity, and JSON has no word for it.
std::optional<double> finite(const std::optional<double>& number) {
  return number && std::isfinite(*number) ? number : std::nullopt;
}

void write_values(const Database& database, const StoredJob& end) {
  Statement row(database, "SELECT number FROM jobs WHERE job_id = ?");
  row.bind(end.status.job_id);
  if (!row.step()) return;
  const std::int64_t number = row.integer(0);
  Statement(database, "DELETE FROM job_values WHERE number = ?").bind(number).run();
  for (const StoredValue& value : end.values) {
    Statement(
        database,
        "INSERT OR IGNORE INTO job_values (number, measurement, name, value, u, expanded_u, lower, upper, verdict) "
        "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(number)
        .bind(value.measurement)
        .bind(value.name)
        .bind(finite(value.value))
        .bind(finite(value.u))
        .bind(finite(value.expanded_u))
        .bind(finite(value.lower))
        .bind(finite(value.upper))
        .bind(value.verdict)
        .run();
  }
}

}  // namespace

void write_end(const Database& database, const StoredJob& end) {
  const auto integer = [](std::uint64_t count) { return static_cast<std::int64_t>(count); };
  const JobStatus& ended = end.status;
  Statement(database,
            "UPDATE jobs SET state = ?, error = ?, error_message = ?, slices_done = ?, slices_planned = ?, "
            "frames_expected = ?, frames_ok = ?, frames_incomplete = ?, frames_missing = ?, frames_stale = ?, "
            "frames_underrun = ?, result_dir = ?, result_json = ?, acquired = ?, files_pending = ?, ended_utc = ?, "
            "verdict = ?, reason_codes = ? WHERE job_id = ?")
      .bind(job_state_name(ended.state))
      .bind(ended.error ? error_name(*ended.error) : std::string_view())
      .bind(ended.error_message)
      .bind(std::int64_t{ended.slices_done})
      .bind(std::int64_t{ended.slices_planned})
      .bind(integer(ended.frames.expected))
      .bind(integer(ended.frames.ok))
      .bind(integer(ended.frames.incomplete))
      .bind(integer(ended.frames.missing))
      .bind(integer(ended.frames.stale))
      .bind(integer(ended.frames.underrun))
      .bind(end.result_dir)
      .bind(end.result_json)
      .bind(std::int64_t{ended.acquired})
      .bind(std::int64_t{end.files_pending})
      .bind(ended.ended_utc)
      .bind(ended.verdict)
      .bind(ended.reason_codes)
      .bind(ended.job_id)
      .run();
  write_values(database, end);
}

}  // namespace fvd
