#include "daemon/store/migrations.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/base/systemd_notify.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/store/database_copy.hpp"

namespace fvd {

namespace {

std::int64_t first_number(const Database& database, const char* sql) {
  Statement query(database, sql);
  return query.step() ? query.integer(0) : 0;
}

/// Version 1, of fvd 0.1.0. States and errors are stored by name: names are the stable contract, numbers are not.
void create_tables(Database& database) {
  database.execute(R"(
CREATE TABLE starts (
  epoch INTEGER NOT NULL
) STRICT;
INSERT INTO starts (epoch) VALUES (0);
CREATE TABLE jobs (
  number            INTEGER PRIMARY KEY AUTOINCREMENT,
  job_id            TEXT    NOT NULL UNIQUE,
  seq               INTEGER NOT NULL UNIQUE,
  part_id           TEXT    NOT NULL,
  recipe            TEXT    NOT NULL,
  state             TEXT    NOT NULL,
  error             TEXT    NOT NULL DEFAULT '',
  error_message     TEXT    NOT NULL DEFAULT '',
  acknowledged      INTEGER NOT NULL DEFAULT 0,
  slices_done       INTEGER NOT NULL DEFAULT 0,
  slices_planned    INTEGER NOT NULL DEFAULT 0,
  frames_expected   INTEGER NOT NULL DEFAULT 0,
  frames_ok         INTEGER NOT NULL DEFAULT 0,
  frames_incomplete INTEGER NOT NULL DEFAULT 0,
  frames_missing    INTEGER NOT NULL DEFAULT 0,
  frames_stale      INTEGER NOT NULL DEFAULT 0,
  frames_underrun   INTEGER NOT NULL DEFAULT 0,
  created_utc       TEXT    NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  ended_utc         TEXT    NOT NULL DEFAULT '',
  result_dir        TEXT    NOT NULL DEFAULT '',
  result_json       TEXT    NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX jobs_waiting ON jobs (number) WHERE acknowledged = 0;
)");
}

/// Version 2: a sequence number is unique for its client alone. SQLite cannot drop the old UNIQUE, so the table is made
/// anew; the number that was given last is carried over, or a deleted row's number would be given again.
void give_sequence_numbers_to_clients(Database& database) {
  database.execute(R"(
CREATE TABLE jobs_2 (
  number            INTEGER PRIMARY KEY AUTOINCREMENT,
  job_id            TEXT    NOT NULL UNIQUE,
  client            TEXT    NOT NULL DEFAULT 'plc',
  seq               INTEGER NOT NULL,
  part_id           TEXT    NOT NULL,
  recipe            TEXT    NOT NULL,
  state             TEXT    NOT NULL,
  error             TEXT    NOT NULL DEFAULT '',
  error_message     TEXT    NOT NULL DEFAULT '',
  acknowledged      INTEGER NOT NULL DEFAULT 0,
  slices_done       INTEGER NOT NULL DEFAULT 0,
  slices_planned    INTEGER NOT NULL DEFAULT 0,
  frames_expected   INTEGER NOT NULL DEFAULT 0,
  frames_ok         INTEGER NOT NULL DEFAULT 0,
  frames_incomplete INTEGER NOT NULL DEFAULT 0,
  frames_missing    INTEGER NOT NULL DEFAULT 0,
  frames_stale      INTEGER NOT NULL DEFAULT 0,
  frames_underrun   INTEGER NOT NULL DEFAULT 0,
  created_utc       TEXT    NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  ended_utc         TEXT    NOT NULL DEFAULT '',
  result_dir        TEXT    NOT NULL DEFAULT '',
  result_json       TEXT    NOT NULL DEFAULT '',
  UNIQUE (client, seq)
) STRICT;
INSERT INTO jobs_2 (number, job_id, seq, part_id, recipe, state, error, error_message, acknowledged, slices_done,
                    slices_planned, frames_expected, frames_ok, frames_incomplete, frames_missing, frames_stale,
                    frames_underrun, created_utc, ended_utc, result_dir, result_json)
  SELECT number, job_id, seq, part_id, recipe, state, error, error_message, acknowledged, slices_done,
         slices_planned, frames_expected, frames_ok, frames_incomplete, frames_missing, frames_stale,
         frames_underrun, created_utc, ended_utc, result_dir, result_json FROM jobs;
DELETE FROM sqlite_sequence WHERE name = 'jobs_2';
INSERT INTO sqlite_sequence (name, seq) SELECT 'jobs_2', seq FROM sqlite_sequence WHERE name = 'jobs';
DROP TABLE jobs;
ALTER TABLE jobs_2 RENAME TO jobs;
CREATE INDEX jobs_waiting ON jobs (number) WHERE acknowledged = 0;
)");
}

/// Version 3: what was saved of a recipe stays, beside the file in force.
void keep_recipe_versions(Database& database) {
  database.execute(R"(
CREATE TABLE recipe_versions (
  recipe    TEXT    NOT NULL,
  version   INTEGER NOT NULL,
  sha256    TEXT    NOT NULL,
  author    TEXT    NOT NULL,
  comment   TEXT    NOT NULL,
  document  TEXT    NOT NULL,
  saved_utc TEXT    NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  PRIMARY KEY (recipe, version)
) STRICT;
)");
}

/// Version 4: whether the part could be moved when a job ended. A row of before says so unless its error says that the
/// stage was not seen at the end.
void keep_whether_the_part_was_free(Database& database) {
  database.execute(R"(
ALTER TABLE jobs ADD COLUMN acquired INTEGER NOT NULL DEFAULT 0;
UPDATE jobs SET acquired = 1 WHERE state <> 'processing' AND error NOT IN ('interrupted', 'stage_disconnected');
)");
}

/// Version 5: the width of the focus curve by which the next scan of a recipe is binned.
void remember_curve_widths(Database& database) {
  database.execute(R"(
CREATE TABLE curve_widths (
  recipe   TEXT    NOT NULL PRIMARY KEY,
  settings TEXT    NOT NULL,
  width_nm INTEGER NOT NULL,
  scans    INTEGER NOT NULL
) STRICT;
)");
}

/// Version 6: bins that would cost heights near the ends of the range. What was learnt before knows nothing of them and
/// may come from scans whose bins did: it is learnt anew.
void remember_bins_that_keep_the_ends(Database& database) {
  database.execute(R"(
DELETE FROM curve_widths;
ALTER TABLE curve_widths ADD COLUMN most_bin_slices INTEGER NOT NULL DEFAULT 64;
)");
}

/// Version 7: which objective is on the microscope, as people confirmed it. The newest row is in force.
void keep_confirmed_objectives(Database& database) {
  database.execute(R"(
CREATE TABLE objective_confirmations (
  number        INTEGER PRIMARY KEY AUTOINCREMENT,
  objective     TEXT    NOT NULL,
  person        TEXT    NOT NULL,
  confirmed_utc TEXT    NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))
) STRICT;
)");
}

/// Version 8: the temperature that came with a job; NULL = none did.
void keep_temperatures_of_jobs(Database& database) {
  database.execute("ALTER TABLE jobs ADD COLUMN temperature_c REAL");
}

/// Version 9: results that were evaluated anew by other recipes, beside their jobs.
void keep_evaluations(Database& database) {
  database.execute(R"(
CREATE TABLE evaluations (
  evaluation_id TEXT    NOT NULL PRIMARY KEY,
  job_id        TEXT    NOT NULL,
  number        INTEGER NOT NULL,
  recipe        TEXT    NOT NULL,
  recipe_sha256 TEXT    NOT NULL,
  verdict       TEXT    NOT NULL,
  result_dir    TEXT    NOT NULL,
  result_json   TEXT    NOT NULL,
  created_utc   TEXT    NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  UNIQUE (job_id, number)
) STRICT;
)");
}

/// Version 10: whether files of the result are still to be made.
void keep_whether_files_are_pending(Database& database) {
  database.execute(R"(
ALTER TABLE jobs ADD COLUMN files_pending INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_with_pending_files ON jobs (number) WHERE files_pending = 1;
)");
}

/// Version 11: what a line asks of its jobs, numbers that count as used without a job, and the prepared recipe.
void keep_what_a_line_asks(Database& database) {
  database.execute(R"(
ALTER TABLE jobs ADD COLUMN session TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN verdict TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN reason_codes TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN removed_utc TEXT NOT NULL DEFAULT '';
UPDATE jobs SET verdict = coalesce(json_extract(result_json, '$.verdict'), '') WHERE json_valid(result_json);
UPDATE jobs SET acquired = 0 WHERE error = 'interrupted';
CREATE INDEX jobs_with_results ON jobs (number, job_id, ended_utc, acknowledged, files_pending, result_dir, removed_utc)
  WHERE result_dir <> '' AND removed_utc = '';
CREATE INDEX jobs_with_removed_results ON jobs (removed_utc, job_id) WHERE removed_utc <> '';
CREATE TABLE seq_floors (
  client TEXT    NOT NULL PRIMARY KEY,
  seq    INTEGER NOT NULL
) STRICT;
CREATE TABLE prepared_recipe (
  one    INTEGER NOT NULL PRIMARY KEY CHECK (one = 1),
  recipe TEXT    NOT NULL
) STRICT;
)");
}

/// Version 12: who asked for what.
void keep_who_asked_for_what(Database& database) {
  database.execute(R"(
CREATE TABLE audit (
  number   INTEGER PRIMARY KEY AUTOINCREMENT,
  time_utc TEXT    NOT NULL,
  who      TEXT    NOT NULL,
  role     TEXT    NOT NULL,
  peer     TEXT    NOT NULL,
  client   TEXT    NOT NULL,
  what     TEXT    NOT NULL,
  detail   TEXT    NOT NULL,
  outcome  TEXT    NOT NULL
) STRICT;
)");
}

/// Version 13: what lists of jobs and run charts are read from. The index holds all that a list tells, so that it never
/// looks into rows, which are long. Values are found by their job; those of jobs that ended before are not filled in.
void keep_what_lists_and_charts_need(Database& database) {
  database.execute(R"(
CREATE INDEX jobs_history ON jobs (number, job_id, client, seq, part_id, recipe, state, verdict, ended_utc, error);
CREATE TABLE job_values (
  number      INTEGER NOT NULL,
  measurement TEXT    NOT NULL,
  name        TEXT    NOT NULL,
  value       REAL,
  u           REAL,
  expanded_u  REAL,
  lower       REAL,
  upper       REAL,
  verdict     TEXT    NOT NULL,
  PRIMARY KEY (number, measurement, name)
) STRICT, WITHOUT ROWID;
CREATE TRIGGER job_values_go_with_their_job AFTER DELETE ON jobs
BEGIN
  DELETE FROM job_values WHERE number = old.number;
END;
)");
}

constexpr std::array kSteps{
    MigrationStep{"tables for jobs and starts", create_tables},
    MigrationStep{"sequence numbers belong to a client", give_sequence_numbers_to_clients},
    MigrationStep{"versions of recipes", keep_recipe_versions},
    MigrationStep{"whether the part was free at a job's end", keep_whether_the_part_was_free},
    MigrationStep{"widths of focus curves", remember_curve_widths},
    MigrationStep{"bins that keep the ends of the range", remember_bins_that_keep_the_ends},
    MigrationStep{"objectives that were confirmed", keep_confirmed_objectives},
    MigrationStep{"temperatures of jobs", keep_temperatures_of_jobs},
    MigrationStep{"evaluations of results by other recipes", keep_evaluations},
    MigrationStep{"whether files of a result are pending", keep_whether_files_are_pending},
    MigrationStep{"sessions, verdicts and removed results of jobs, floors of numbers, the prepared recipe",
                  keep_what_a_line_asks},
    MigrationStep{"who asked for what", keep_who_asked_for_what},
    MigrationStep{"what lists of jobs and run charts are read from", keep_what_lists_and_charts_need},
};

void require_own_file(const Database& database, int version) {
  if (version > newest_schema_version()) {
    throw Error(ErrorCode::kDatabase, "database " + database.file().string() + " has version " +
                                          std::to_string(version) + ", this fvd knows versions up to " +
                                          std::to_string(newest_schema_version()) +
                                          ": install the newer fvd that wrote it, or move the file away to start anew");
  }
  const bool is_new = first_number(database, "SELECT count(*) FROM sqlite_schema") == 0;
  const bool has_our_tables =
      first_number(database,
                   "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('starts', 'jobs')") == 2;
  if (version == 0 ? !is_new : version < 0 || !has_our_tables) {
    throw Error(ErrorCode::kDatabase, "database " + database.file().string() +
                                          " was made by another program: move it away, or name another state_dir");
  }
}

/// A copy appears whole or not at all; no start was counted since it was made where the epoch is the same.
bool is_copied(const Database& database, const std::filesystem::path& copy) {
  std::error_code error;
  if (!std::filesystem::exists(copy, error)) return false;
  try {
    const char* const epoch = "SELECT epoch FROM starts";
    const Database earlier(copy);
    return schema_version(earlier) == schema_version(database) &&
           first_number(earlier, epoch) == first_number(database, epoch);
  } catch (const Error&) {
    return false;  // it is made anew
  }
}

/// The one just made is kept and one of the others, of the highest version. What cannot be removed stays.
void drop_older_copies(const std::filesystem::path& database, const std::filesystem::path& made) {
  const std::string prefix = database.filename().string() + ".v";
  std::map<int, std::filesystem::path> copies;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(std::filesystem::absolute(database).parent_path(), error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::string digits = name.starts_with(prefix) ? name.substr(prefix.size()) : "";
    const bool is_number =
        !digits.empty() && digits.size() < 6 && digits.find_first_not_of("0123456789") == digits.npos;
    if (is_number && entry->path().filename() != made.filename()) copies.emplace(std::stoi(digits), entry->path());
  }
  for (auto oldest = copies.begin(); copies.size() > 1; oldest = copies.erase(oldest)) {
    const bool removed = file_calls().unlink(oldest->second) == 0;
    spdlog::info("database {}: the older copy {} {}: two are kept", database.string(), oldest->second.string(),
                 removed ? "is removed" : "cannot be removed");
  }
}

/// Far more than copying or rewriting a database of its size takes.
std::chrono::seconds longest_step(const Database& database) {
  constexpr std::uintmax_t kSlowest_bytes_per_s = 2'000'000;
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(database.file(), error);
  return std::chrono::seconds(90 + (error ? 0 : static_cast<std::int64_t>(bytes / kSlowest_bytes_per_s)));
}

}  // namespace

std::span<const MigrationStep> migration_steps() { return kSteps; }

int newest_schema_version() { return static_cast<int>(kSteps.size()); }

int schema_version(const Database& database) { return static_cast<int>(first_number(database, "PRAGMA user_version")); }

void migrate(Database& database, int version) {
  const int found = schema_version(database);
  require_own_file(database, found);
  if (found > 0 && found < version) {
    const std::string copy = database.file().string() + ".v" + std::to_string(found);
    notify_extend_timeout(longest_step(database), "copying the database before it is brought up to date");
    if (!is_copied(database, copy)) copy_database(database, copy);
    spdlog::info("database {}: a copy of version {} is kept as {}", database.file().string(), found, copy);
    drop_older_copies(database.file(), copy);
  }
  database.use_write_ahead_log();
  for (int from = found; from < version; ++from) {
    const MigrationStep& step = kSteps.at(static_cast<std::size_t>(from));
    notify_extend_timeout(longest_step(database), "bringing the database up to date: " + std::string(step.what));
    Transaction transaction(database);
    step.run(database);
    database.execute(("PRAGMA user_version = " + std::to_string(from + 1)).c_str());
    transaction.commit();
    if (found == 0) continue;  // a new file
    spdlog::info("database {}: version {} -> {}: {}", database.file().string(), from, from + 1, step.what);
  }
}

}  // namespace fvd
