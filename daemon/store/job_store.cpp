#include "daemon/store/job_store.hpp"

#include <array>
#include <cstdio>
#include <ctime>
#include <mutex>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "daemon/store/database.hpp"

namespace fvd {

namespace {

constexpr const char* kSchema = R"sql(
CREATE TABLE IF NOT EXISTS counters (name TEXT PRIMARY KEY, value INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS jobs (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  job_id TEXT NOT NULL UNIQUE,
  seq INTEGER NOT NULL UNIQUE,
  part_id TEXT NOT NULL,
  recipe TEXT NOT NULL,
  accepted_s INTEGER NOT NULL,
  state TEXT NOT NULL,
  error TEXT NOT NULL DEFAULT '',
  message TEXT NOT NULL DEFAULT '',
  slices_done INTEGER NOT NULL DEFAULT 0,
  slices_planned INTEGER NOT NULL DEFAULT 0,
  frames TEXT NOT NULL DEFAULT '[0,0,0,0,0,0]',
  result_dir TEXT NOT NULL DEFAULT '',
  result_json TEXT NOT NULL DEFAULT '',
  acknowledged INTEGER NOT NULL DEFAULT 0
);
CREATE INDEX IF NOT EXISTS waiting ON jobs (acknowledged, number);
PRAGMA user_version = 1;
)sql";

constexpr const char* kColumns =
    "job_id, seq, part_id, recipe, state, error, message, slices_done, slices_planned, frames, acknowledged, result_dir, "
    "result_json";

std::string select(const std::string& condition) {
  return std::string("SELECT ") + kColumns + " FROM jobs WHERE " + condition;
}

std::string frames_text(const FrameCounts& frames) {
  return nlohmann::json{frames.expected, frames.ok, frames.incomplete, frames.missing, frames.stale, frames.underrun}.dump();
}

FrameCounts frames_from(const std::string& text) {
  const auto list = nlohmann::json::parse(text).get<std::array<std::uint64_t, 6>>();
  return {list[0], list[1], list[2], list[3], list[4], list[5]};
}

JobState state_from(const std::string& name) {
  for (const JobState state : {JobState::kProcessing, JobState::kCompleted, JobState::kAborted}) {
    if (name == job_state_name(state)) return state;
  }
  return JobState::kFailed;
}

StoredJob read_row(const Statement& row) {
  StoredJob job;
  job.status.job_id = row.text(0);
  job.status.request = {row.integer(1), row.text(2), row.text(3)};
  job.status.state = state_from(row.text(4));
  if (const std::string error = row.text(5); !error.empty()) job.status.error = error_from_name(error);
  job.status.error_message = row.text(6);
  job.status.slices_done = static_cast<int>(row.integer(7));
  job.status.slices_planned = static_cast<int>(row.integer(8));
  job.status.frames = frames_from(row.text(9));
  job.status.acknowledged = row.integer(10) != 0;
  job.status.acquired = job.status.state != JobState::kProcessing;
  job.result_dir = row.text(11);
  job.result_json = row.text(12);
  return job;
}

std::string describe(const JobKey& key) {
  if (const auto* id = std::get_if<std::string>(&key)) return "job_id '" + *id + "'";
  return "seq " + std::to_string(std::get<std::int64_t>(key));
}

}  // namespace

struct JobStore::Impl {
  explicit Impl(const std::filesystem::path& file) : database(file) {
    database.execute(kSchema);
    Transaction transaction(database);
    Statement(database, "INSERT INTO counters VALUES ('epoch', 1) ON CONFLICT (name) DO UPDATE SET value = value + 1").run();
    Statement row(database, "SELECT value FROM counters WHERE name = 'epoch'");
    if (row.step()) epoch = row.integer(0);
    Statement(database, "UPDATE jobs SET state = 'failed', error = ?, message = ? WHERE state = 'processing'")
        .bind(error_name(ErrorCode::kInterrupted))
        .bind("the daemon ended while the job ran; measure the part again")
        .run();
    transaction.commit();
  }

  [[nodiscard]] std::optional<StoredJob> find(const JobKey& key) const {
    const bool by_id = std::holds_alternative<std::string>(key);
    Statement row(database, select(by_id ? "job_id = ?" : "seq = ?").c_str());
    if (by_id) {
      row.bind(std::get<std::string>(key));
    } else {
      row.bind(std::get<std::int64_t>(key));
    }
    if (!row.step()) return std::nullopt;
    return read_row(row);
  }

  [[nodiscard]] std::optional<JobStatus> first(const std::string& condition) const {
    Statement row(database, select(condition).c_str());
    if (!row.step()) return std::nullopt;
    return read_row(row).status;
  }

  [[nodiscard]] std::int64_t number(const char* sql) const {
    Statement row(database, sql);
    return row.step() ? row.integer(0) : 0;
  }

  Database database;
  std::int64_t epoch = 0;
  mutable std::mutex mutex;
};

JobStore::JobStore(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}
JobStore::~JobStore() = default;

std::optional<JobStatus> JobStore::find_repeated(const JobRequest& request) const {
  const std::lock_guard lock(impl_->mutex);
  if (const auto known = impl_->find(request.seq)) {
    const JobRequest& old = known->status.request;
    // A request without a recipe meant the prepared one; the row names it.
    if (old.part_id == request.part_id && (request.recipe.empty() || old.recipe == request.recipe)) return known->status;
    throw Error(ErrorCode::kSeqConflict, "seq " + std::to_string(request.seq) + " was used for part '" + old.part_id +
                                             "' with recipe '" + old.recipe + "'; a new job needs a new seq");
  }
  const std::int64_t newest = impl_->number("SELECT COALESCE(MAX(seq), 0) FROM jobs");
  if (request.seq < newest - kSeqWindow) {
    throw Error(ErrorCode::kSeqStale, "seq " + std::to_string(request.seq) + " is more than " + std::to_string(kSeqWindow) +
                                          " behind the newest, " + std::to_string(newest));
  }
  return std::nullopt;
}

JobStatus JobStore::accept(const JobRequest& request) {
  const std::lock_guard lock(impl_->mutex);
  JobStatus job;
  job.request = request;
  const std::time_t now = std::time(nullptr);
  const std::int64_t number = 1 + impl_->number("SELECT COALESCE(MAX(number), 0) FROM jobs");
  std::tm utc{};
  gmtime_r(&now, &utc);
  // Sorts by time, and by number within a second; the epoch keeps it unique if the clock is set back.
  std::array<char, 64> id{};
  std::snprintf(id.data(), id.size(), "%04d%02d%02dT%02d%02d%02d-%06lld", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                utc.tm_hour, utc.tm_min, utc.tm_sec, static_cast<long long>(number));
  job.job_id = id.data();
  Statement(impl_->database, "INSERT INTO jobs (job_id, seq, part_id, recipe, accepted_s, state) VALUES (?, ?, ?, ?, ?, 'processing')")
      .bind(job.job_id)
      .bind(request.seq)
      .bind(request.part_id)
      .bind(request.recipe)
      .bind(std::int64_t{now})
      .run();
  return job;
}

void JobStore::finish(const JobStatus& ended, const std::string& result_dir, const std::string& result_json) {
  const std::lock_guard lock(impl_->mutex);
  Statement(impl_->database,
            "UPDATE jobs SET state = ?, error = ?, message = ?, slices_done = ?, slices_planned = ?, frames = ?, "
            "result_dir = ?, result_json = ? WHERE job_id = ?")
      .bind(job_state_name(ended.state))
      .bind(ended.error ? error_name(*ended.error) : "")
      .bind(ended.error_message)
      .bind(std::int64_t{ended.slices_done})
      .bind(std::int64_t{ended.slices_planned})
      .bind(frames_text(ended.frames))
      .bind(result_dir)
      .bind(result_json)
      .bind(ended.job_id)
      .run();
}

StoredJob JobStore::find(const JobKey& key) const {
  const std::lock_guard lock(impl_->mutex);
  auto job = impl_->find(key);
  if (!job) throw Error(ErrorCode::kUnknownJob, "there is no job with " + describe(key));
  return std::move(*job);
}

std::optional<JobStatus> JobStore::latest() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->first("1 ORDER BY number DESC LIMIT 1");
}

std::optional<JobStatus> JobStore::next_unacknowledged() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->first("acknowledged = 0 AND state != 'processing' ORDER BY number LIMIT 1");
}

int JobStore::unacknowledged_count() const {
  const std::lock_guard lock(impl_->mutex);
  return static_cast<int>(impl_->number("SELECT COUNT(*) FROM jobs WHERE acknowledged = 0 AND state != 'processing'"));
}

int JobStore::acknowledge(const JobKey& key) {
  const StoredJob job = find(key);
  {
    const std::lock_guard lock(impl_->mutex);
    Statement(impl_->database, "UPDATE jobs SET acknowledged = 1 WHERE job_id = ?").bind(job.status.job_id).run();
  }
  return unacknowledged_count();
}

std::int64_t JobStore::epoch() const noexcept { return impl_->epoch; }

}  // namespace fvd
