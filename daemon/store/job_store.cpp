#include "daemon/store/job_store.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <sstream>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "daemon/store/database.hpp"
#include "daemon/store/job_id.hpp"
#include "daemon/store/migrations.hpp"
#include "daemon/store/recipe_table.hpp"

namespace fvd {

namespace {

constexpr std::array kAllJobStates{JobState::kProcessing, JobState::kCompleted, JobState::kAborted, JobState::kFailed};

/// Columns in the order in which read_row() takes them.
#define FVD_JOB_COLUMNS                                                                                            \
  "job_id, client, seq, part_id, recipe, state, error, error_message, acknowledged, slices_done, slices_planned, " \
  "frames_expected, frames_ok, frames_incomplete, frames_missing, frames_stale, frames_underrun, result_dir, "     \
  "result_json, acquired, temperature_c, files_pending"

JobState state_from_name(const std::string& name) {
  for (const JobState state : kAllJobStates) {
    if (job_state_name(state) == name) return state;
  }
  return JobState::kFailed;
}

StoredJob read_row(const Statement& row) {
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
  status.state = state_from_name(text());
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
  return job;
}

using KeptEnds = std::map<std::string, StoredJob>;  // by job_id

/// The row, or the job's end that the row does not have yet.
StoredJob as_it_stands(const StoredJob& row, const KeptEnds& kept) {
  const auto end = kept.find(row.status.job_id);
  return end == kept.end() ? row : end->second;
}

std::optional<JobStatus> first_status(Statement& rows, const KeptEnds& kept) {
  if (!rows.step()) return std::nullopt;
  return as_it_stands(read_row(rows), kept).status;
}

std::string number_text(std::int64_t seq, const std::string& client) {
  return "seq " + std::to_string(seq) + " of client '" + client + "'";
}

std::string key_text(const JobKey& key) {
  if (const auto* id = std::get_if<std::string>(&key)) return "'" + *id + "'";
  const auto& number = std::get<ClientSeq>(key);
  return "with " + number_text(number.seq, number.client);
}

std::string temperature_text(const std::optional<double>& temperature_c) {
  if (!temperature_c) return {};
  std::ostringstream text;
  text << ", temperature_c " << *temperature_c;
  return text.str();
}

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
  return as_it_stands(read_row(query), kept);
}

std::optional<JobStatus> repeated_in(const Database& database, const KeptEnds& kept, const JobRequest& request) {
  const std::string number = number_text(request.seq, request.client);
  Statement query(database, "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE client = ? AND seq = ?");
  query.bind(request.client).bind(request.seq);
  auto known = first_status(query, kept);
  if (!known) {
    Statement highest(database, "SELECT max(seq) FROM jobs WHERE client = ?");
    highest.bind(request.client);
    const std::int64_t newest = highest.step() ? highest.integer(0) : 0;
    if (request.seq < newest - JobStore::kSeqWindow) {
      throw Error(ErrorCode::kSeqStale, number + " is more than " + std::to_string(JobStore::kSeqWindow) +
                                            " behind the newest, " + std::to_string(newest) + ": continue from there");
    }
    return std::nullopt;
  }
  const bool same_recipe = request.recipe.empty() || request.recipe == known->request.recipe;
  const bool same_temperature = request.temperature_c == known->request.temperature_c;
  if (known->request.part_id != request.part_id || !same_recipe || !same_temperature) {
    throw Error(ErrorCode::kSeqConflict, number + " belongs to job " + known->job_id + " (part '" +
                                             known->request.part_id + "', recipe '" + known->request.recipe + "'" +
                                             temperature_text(known->request.temperature_c) +
                                             "): use a new number for a new job");
  }
  return known;
}

std::filesystem::path with_folder(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::absolute(file).parent_path(), error);
  if (error) {
    throw Error(ErrorCode::kDatabase,
                "cannot create the folder of the database " + file.string() + ": " + error.message());
  }
  return file;
}

}  // namespace

struct JobStore::Impl {
  explicit Impl(const std::filesystem::path& file) : database(with_folder(file)) {}

  void count_start() {
    const MutexLock lock(mutex);
    migrate(database);
    Transaction transaction(database);
    database.execute("UPDATE starts SET epoch = epoch + 1");
    Statement(database,
              "UPDATE jobs SET state = ?, error = ?, error_message = ?, "
              "ended_utc = strftime('%Y-%m-%dT%H:%M:%fZ', 'now') WHERE state = ?")
        .bind(job_state_name(JobState::kFailed))
        .bind(error_name(ErrorCode::kInterrupted))
        .bind("the daemon stopped while the job ran: measure the part again with a new sequence number")
        .bind(job_state_name(JobState::kProcessing))
        .run();
    epoch = scalar(database, "SELECT epoch FROM starts");
    transaction.commit();
    // From here on every job that is not acknowledged has ended, until one is accepted.
    waiting = static_cast<int>(scalar(database, "SELECT count(*) FROM jobs WHERE acknowledged = 0"));
  }

  void store_end_locked(const StoredJob& end) FVD_REQUIRES(mutex);
  void store_kept_ends_locked() FVD_REQUIRES(mutex);

  /// Of now: who reads rows afterwards misses no end.
  [[nodiscard]] KeptEnds kept() const {
    const MutexLock lock(kept_mutex);
    return kept_ends;
  }

  Mutex mutex;  // held while a commit waits for the disk
  Database database FVD_GUARDED_BY(mutex);
  Mutex read_mutex;  // never held then; never together with mutex
  Database reader FVD_GUARDED_BY(read_mutex){Database::reader_of(database)};
  mutable Mutex kept_mutex;                       // innermost
  KeptEnds kept_ends FVD_GUARDED_BY(kept_mutex);  ///< that could not be stored yet
  RecipeTable recipes{{database, mutex}, {reader, read_mutex}};
  CurveWidthTable widths{{database, mutex}, {reader, read_mutex}};
  ObjectiveTable objectives{{database, mutex}, {reader, read_mutex}};
  EvaluationTable evaluations{{database, mutex}, {reader, read_mutex}};
  AuditTable audit{{database, mutex}, {reader, read_mutex}};
  std::int64_t epoch = 0;       // set before the store is used
  std::atomic<int> waiting{0};  // ended and not acknowledged; written under the mutex, read without
};

JobStore::JobStore(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) { impl_->count_start(); }

JobStore::~JobStore() = default;

std::optional<JobStatus> JobStore::find_repeated(const JobRequest& request) const {
  const KeptEnds kept = impl_->kept();
  const MutexLock lock(impl_->read_mutex);
  return repeated_in(impl_->reader, kept, request);
}

JobStatus JobStore::accept(const JobRequest& request) {
  const MutexLock lock(impl_->mutex);
  impl_->store_kept_ends_locked();
  Transaction transaction(impl_->database);
  if (const auto known = repeated_in(impl_->database, {}, request)) {
    throw Error(ErrorCode::kSeqConflict,
                number_text(request.seq, request.client) + " was accepted before, as job " + known->job_id);
  }
  // sqlite_sequence holds the number given last; it never goes back, even if rows are deleted.
  const std::int64_t number =
      1 + scalar(impl_->database, "SELECT coalesce(max(seq), 0) FROM sqlite_sequence WHERE name = 'jobs'");
  JobStatus job;
  job.job_id = make_job_id(std::chrono::system_clock::now(), impl_->epoch, number);
  job.request = request;
  Statement(impl_->database,
            "INSERT INTO jobs (number, job_id, client, seq, part_id, recipe, state, temperature_c) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(number)
      .bind(job.job_id)
      .bind(request.client)
      .bind(request.seq)
      .bind(request.part_id)
      .bind(request.recipe)
      .bind(job_state_name(job.state))
      .bind(request.temperature_c)
      .run();
  transaction.commit();
  return job;
}

void JobStore::Impl::store_end_locked(const StoredJob& end) {
  const auto integer = [](std::uint64_t count) { return static_cast<std::int64_t>(count); };
  const JobStatus& ended = end.status;
  Transaction transaction(database);
  Statement(database,
            "UPDATE jobs SET state = ?, error = ?, error_message = ?, slices_done = ?, slices_planned = ?, "
            "frames_expected = ?, frames_ok = ?, frames_incomplete = ?, frames_missing = ?, frames_stale = ?, "
            "frames_underrun = ?, result_dir = ?, result_json = ?, acquired = ?, "
            "files_pending = ?, ended_utc = strftime('%Y-%m-%dT%H:%M:%fZ', 'now') WHERE job_id = ?")
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
      .bind(ended.job_id)
      .run();
  transaction.commit();
}

void JobStore::Impl::store_kept_ends_locked() {
  for (const auto& [job_id, end] : kept()) {
    try {
      store_end_locked(end);
    } catch (const Error& error) {
      throw Error(error.code(), "the end of job " + job_id + " is not stored yet: " + error.what());
    }
    spdlog::info("job {}: its end is stored now", job_id);
    const MutexLock lock(kept_mutex);
    kept_ends.erase(job_id);
  }
}

void JobStore::finish(const JobStatus& ended, const std::string& result_dir, const std::string& result_json,
                      bool files_pending) {
  StoredJob end{ended, result_dir, result_json, files_pending};
  const MutexLock lock(impl_->mutex);
  bool was_running = true;  // also where the database cannot be asked
  try {
    was_running = job_in(impl_->database, impl_->kept(), ended.job_id).status.state == JobState::kProcessing;
    impl_->store_end_locked(end);
    const MutexLock kept_lock(impl_->kept_mutex);
    impl_->kept_ends.erase(ended.job_id);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kUnknownJob) throw;
    end.status.not_durable = error.what();
    {
      const MutexLock kept_lock(impl_->kept_mutex);
      impl_->kept_ends[ended.job_id] = std::move(end);
    }
    if (was_running) ++impl_->waiting;
    throw;
  }
  if (was_running) ++impl_->waiting;
}

void JobStore::note_files(const std::string& job_id, const std::string& result_json, bool files_pending) {
  const MutexLock lock(impl_->mutex);
  {
    const MutexLock kept_lock(impl_->kept_mutex);
    if (const auto kept = impl_->kept_ends.find(job_id); kept != impl_->kept_ends.end()) {
      kept->second.result_json = result_json;  // stored with the end
      kept->second.files_pending = files_pending;
      return;
    }
  }
  (void)job_in(impl_->database, {}, job_id);
  Statement(impl_->database, "UPDATE jobs SET result_json = ?, files_pending = ? WHERE job_id = ?")
      .bind(result_json)
      .bind(std::int64_t{files_pending})
      .bind(job_id)
      .run();
}

std::vector<StoredJob> JobStore::with_pending_files() const {
  const MutexLock lock(impl_->read_mutex);
  Statement query(impl_->reader, "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE files_pending = 1 ORDER BY number");
  std::vector<StoredJob> jobs;
  while (query.step()) jobs.push_back(read_row(query));
  return jobs;
}

void JobStore::store_kept_ends() {
  const MutexLock lock(impl_->mutex);
  impl_->store_kept_ends_locked();
}

StoredJob JobStore::find(const JobKey& key) const {
  const KeptEnds kept = impl_->kept();
  const MutexLock lock(impl_->read_mutex);
  return job_in(impl_->reader, kept, key);
}

std::optional<JobStatus> JobStore::latest() const {
  const KeptEnds kept = impl_->kept();
  const MutexLock lock(impl_->read_mutex);
  Statement query(impl_->reader, "SELECT " FVD_JOB_COLUMNS " FROM jobs ORDER BY number DESC LIMIT 1");
  return first_status(query, kept);
}

std::optional<JobStatus> JobStore::highest(const std::string& client) const {
  const KeptEnds kept = impl_->kept();
  const MutexLock lock(impl_->read_mutex);
  Statement query(impl_->reader, "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE client = ? ORDER BY seq DESC LIMIT 1");
  query.bind(client);
  return first_status(query, kept);
}

std::optional<JobStatus> JobStore::next_unacknowledged() const {
  const KeptEnds kept = impl_->kept();
  const MutexLock lock(impl_->read_mutex);
  Statement query(impl_->reader,
                  "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE acknowledged = 0 AND state <> ? ORDER BY number LIMIT 1");
  query.bind(job_state_name(JobState::kProcessing));
  if (auto oldest = first_status(query, kept)) return oldest;
  // No job is accepted while an end is kept, so that it is the newest.
  if (!kept.empty()) return kept.begin()->second.status;
  return std::nullopt;
}

int JobStore::unacknowledged_count() const noexcept { return impl_->waiting; }

int JobStore::acknowledge(const JobKey& key) {
  const MutexLock lock(impl_->mutex);
  impl_->store_kept_ends_locked();
  const JobStatus job = job_in(impl_->database, {}, key).status;
  if (job.state == JobState::kProcessing) {
    throw Error(ErrorCode::kBusy, "job " + job.job_id + " is still running; acknowledge it when it has ended");
  }
  if (!job.acknowledged) {
    Statement(impl_->database, "UPDATE jobs SET acknowledged = 1 WHERE job_id = ?").bind(job.job_id).run();
    --impl_->waiting;
  }
  return impl_->waiting;
}

RecipeVersions& JobStore::recipe_versions() noexcept { return impl_->recipes; }

CurveWidthTable& JobStore::curve_widths() noexcept { return impl_->widths; }

ObjectiveTable& JobStore::objectives() noexcept { return impl_->objectives; }

AuditTable& JobStore::audit() noexcept { return impl_->audit; }
EvaluationTable& JobStore::evaluations() noexcept { return impl_->evaluations; }

std::int64_t JobStore::epoch() const noexcept { return impl_->epoch; }

}  // namespace fvd
