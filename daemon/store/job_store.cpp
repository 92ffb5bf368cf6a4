#include "daemon/store/job_store.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/store/database.hpp"
#include "daemon/store/job_id.hpp"
#include "daemon/store/job_rows.hpp"
#include "daemon/store/migrations.hpp"
#include "daemon/store/recipe_table.hpp"
#include "daemon/store/storage_reserve.hpp"
#include "daemon/store/store_marker.hpp"

namespace fvd {

namespace {

std::filesystem::path with_folder(const std::filesystem::path& file) {
  (void)make_directories(std::filesystem::absolute(file).parent_path());
  return file;
}

/// Where the database is, or may be made.
std::filesystem::path checked_file(const std::filesystem::path& file, const JobStore::Options& options) {
  if (!options.start_anew) require_no_lost_database(file);
  return with_folder(file);
}

/// The same one again writes nothing: most jobs run by the recipe of the job before.
void remember_in(const Database& database, const std::string& recipe_id) {
  Statement(database,
            "INSERT INTO prepared_recipe (one, recipe) VALUES (1, ?) "
            "ON CONFLICT (one) DO UPDATE SET recipe = excluded.recipe WHERE recipe <> excluded.recipe")
      .bind(recipe_id)
      .run();
}

}  // namespace

struct JobStore::Impl {
  Impl(const std::filesystem::path& path, const Options& given)
      : options(given),
        file(path),
        database(checked_file(path, given)),
        reserve(std::filesystem::path(path) += ".reserve") {}

  void count_start();
  void keep_marker_locked() FVD_REQUIRES(mutex);
  void note_number_locked(const JobRequest& request) FVD_REQUIRES(mutex);
  void store_end_locked(const StoredJob& end) FVD_REQUIRES(mutex);
  void store_kept_ends_locked() FVD_REQUIRES(mutex);

  /// Of now: who reads rows afterwards misses no end.
  [[nodiscard]] KeptEnds kept() const {
    const MutexLock lock(kept_mutex);
    return kept_ends;
  }

  const Options options;
  const std::filesystem::path file;
  Mutex mutex;  // held while a commit waits for the disk
  Database database FVD_GUARDED_BY(mutex);
  Mutex read_mutex;  // never held then; never together with mutex
  Database reader FVD_GUARDED_BY(read_mutex){Database::reader_of(database)};
  Mutex log_mutex;  // held while the write-ahead log is moved; never together with another
  Database log_mover FVD_GUARDED_BY(log_mutex){Database::reader_of(database)};
  Mutex history_mutex;  // held while long lists are read: nobody else waits for them; never together with another
  Database history_reader FVD_GUARDED_BY(history_mutex){Database::reader_of(database)};
  mutable Mutex kept_mutex;                       // innermost
  KeptEnds kept_ends FVD_GUARDED_BY(kept_mutex);  ///< that could not be stored yet
  RecipeTable recipes{{database, mutex}, {reader, read_mutex}};
  CurveWidthTable widths{{database, mutex}, {reader, read_mutex}};
  ObjectiveTable objectives{{database, mutex}, {reader, read_mutex}};
  EvaluationTable evaluations{{database, mutex}, {reader, read_mutex}};
  ResultTable on_disk{{database, mutex}, {reader, read_mutex}};
  StorageReserve reserve FVD_GUARDED_BY(mutex);
  StoreMarker marker FVD_GUARDED_BY(mutex);
  AuditTable audit{{database, mutex}, {reader, read_mutex}};
  JobHistory history{{history_reader, history_mutex}, [this] { return kept(); }};
  std::int64_t epoch = 0;  // set before the store is used, as the next one
  std::vector<std::string> interrupted;
  std::atomic<int> waiting{0};  // ended and not acknowledged; written under the mutex, read without
  std::atomic<int> results{0};  // of these the completed ones
  mutable Mutex newest_mutex;   // held for a pointer's copy alone
  std::shared_ptr<const NewestSeqs> newest FVD_GUARDED_BY(newest_mutex);
};

void JobStore::Impl::count_start() {
  const MutexLock lock(mutex);
  const auto found = read_marker(database.file());
  migrate(database);
  Transaction transaction(database);
  if (found && is_older(database, *found)) {
    spdlog::warn("database {}: it is older than the one of before, or another file: its epoch goes on behind {}; {}",
                 database.file().string(), found->epoch,
                 found->margin == 0 ? std::string("the numbers that were used since are known, and are not run again")
                                    : unknown_numbers_text(found->margin));
    Statement(database, "UPDATE starts SET epoch = max(epoch, ?)").bind(found->epoch).run();
    raise_seq_floors(database, found->newest_seq, found->margin);
  }
  database.execute("UPDATE starts SET epoch = epoch + 1");
  Statement running(database, "SELECT job_id FROM jobs WHERE state = ?");
  running.bind(job_state_name(JobState::kProcessing));
  while (running.step()) interrupted.push_back(running.text(0));
  // A backup tells why, and when, of the jobs that it found running.
  Statement(database,
            "UPDATE jobs SET state = ?, error = ?, "
            "error_message = CASE error_message WHEN '' THEN ? ELSE error_message END, "
            "ended_utc = CASE ended_utc WHEN '' THEN ? ELSE ended_utc END WHERE state = ?")
      .bind(job_state_name(JobState::kFailed))
      .bind(error_name(ErrorCode::kInterrupted))
      .bind("the daemon stopped while the job ran: measure the part again with a new sequence number")
      .bind(utc_now())
      .bind(job_state_name(JobState::kProcessing))
      .run();
  epoch = scalar(database, "SELECT epoch FROM starts");
  transaction.commit();
  // From here on every job that is not acknowledged has ended, until one is accepted.
  waiting = static_cast<int>(scalar(database, "SELECT count(*) FROM jobs WHERE acknowledged = 0"));
  results =
      static_cast<int>(scalar(database, "SELECT count(*) FROM jobs WHERE acknowledged = 0 AND state = 'completed'"));
  marker.newest_seq = newest_seqs_in(database);
  marker.file = file_mark(database.file());
  {
    const MutexLock newest_lock(newest_mutex);
    newest = std::make_shared<const NewestSeqs>(marker.newest_seq);
  }
  keep_marker_locked();
}

void JobStore::Impl::keep_marker_locked() {
  marker.epoch = epoch;
  write_marker(database.file(), marker);
}

JobStore::JobStore(const std::filesystem::path& file, const Options& options)
    : impl_(std::make_unique<Impl>(file, options)) {
  impl_->count_start();
}

JobStore::~JobStore() = default;

std::optional<JobStatus> JobStore::find_repeated(const JobRequest& request) const {
  if (is_surely_new(*newest_seqs(), request)) return std::nullopt;  // accept() looks into the database
  const KeptEnds kept = impl_->kept();
  const MutexLock lock(impl_->read_mutex);
  return repeated_in(impl_->reader, kept, request, impl_->options.repeat_window);
}

JobStatus JobStore::accept(const JobRequest& request) {
  const MutexLock lock(impl_->mutex);
  impl_->store_kept_ends_locked();
  impl_->reserve.take();
  Transaction transaction(impl_->database);
  if (const auto known = repeated_in(impl_->database, {}, request, impl_->options.repeat_window)) {
    throw Error(ErrorCode::kSeqConflict,
                number_text(request.seq, request.client) + " was accepted before, as job " + known->job_id);
  }
  impl_->note_number_locked(request);
  // sqlite_sequence holds the number given last; it never goes back, even if rows are deleted.
  const std::int64_t number =
      1 + scalar(impl_->database, "SELECT coalesce(max(seq), 0) FROM sqlite_sequence WHERE name = 'jobs'");
  JobStatus job;
  job.job_id = make_job_id(std::chrono::system_clock::now(), impl_->epoch, number);
  job.request = request;
  Statement(impl_->database,
            "INSERT INTO jobs (number, job_id, client, seq, part_id, recipe, state, temperature_c, session) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(number)
      .bind(job.job_id)
      .bind(request.client)
      .bind(request.seq)
      .bind(request.part_id)
      .bind(request.recipe)
      .bind(job_state_name(job.state))
      .bind(request.temperature_c)
      .bind(request.session)
      .run();
  remember_in(impl_->database, request.recipe);
  transaction.commit();
  const MutexLock newest_lock(impl_->newest_mutex);
  auto newest = std::make_shared<NewestSeqs>(*impl_->newest);
  std::int64_t& of_client = (*newest)[request.client];
  of_client = std::max(of_client, request.seq);
  impl_->newest = std::move(newest);
  return job;
}

/// Where the disk is full the room that was held for it takes it.
void JobStore::Impl::store_end_locked(const StoredJob& end) {
  const auto store = [this, &end] {
    mutex.assert_held();
    Transaction transaction(database);
    write_end(database, end);
    transaction.commit();
  };
  try {
    store();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kStorageFull) throw;
    reserve.give_back();
    store();
  }
}

/// What is written of it beside the database is never further behind than the margin says.
void JobStore::Impl::note_number_locked(const JobRequest& request) {
  const auto known = marker.newest_seq.find(request.client);
  if (known != marker.newest_seq.end() && request.seq <= known->second + kSeqJump / 2) return;
  StoreMarker next = marker;
  next.newest_seq[request.client] = request.seq;
  next.epoch = epoch;
  next.margin = kSeqJump;
  write_marker(database.file(), next);
  marker = next;
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
                      bool files_pending, const std::vector<StoredValue>& values) {
  StoredJob end{ended, result_dir, result_json, files_pending, values};
  if (end.status.ended_utc.empty()) end.status.ended_utc = utc_now();
  const MutexLock lock(impl_->mutex);
  bool was_running = true;  // also where the database cannot be asked
  bool was_result = false;
  const auto count = [&] {
    if (was_running) ++impl_->waiting;
    if (ended.state == JobState::kCompleted && !was_result) ++impl_->results;
  };
  try {
    const JobStatus before = job_in(impl_->database, impl_->kept(), ended.job_id).status;
    was_running = before.state == JobState::kProcessing;
    was_result = before.state == JobState::kCompleted;
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
    count();
    throw;
  }
  count();
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

void JobStore::shorten_log() noexcept {
  try {
    const MutexLock lock(impl_->log_mutex);
    impl_->log_mover.move_log();
  } catch (const std::exception& failure) {
    spdlog::warn("{}", failure.what());
  }
}

std::vector<StoredJob> JobStore::with_pending_files() const {
  const MutexLock lock(impl_->read_mutex);
  Statement query(impl_->reader, "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE files_pending = 1 ORDER BY number");
  std::vector<StoredJob> jobs;
  while (query.step()) jobs.push_back(read_job_row(query));
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

int JobStore::unacknowledged_results() const noexcept { return impl_->results; }

std::shared_ptr<const NewestSeqs> JobStore::newest_seqs() const {
  const MutexLock lock(impl_->newest_mutex);
  return impl_->newest;
}

std::string JobStore::kept_end() const {
  const MutexLock lock(impl_->kept_mutex);
  if (impl_->kept_ends.empty()) return {};
  const auto& [job_id, end] = *impl_->kept_ends.begin();
  return "the end of job " + job_id + " is not stored yet: " + end.status.not_durable;
}

void JobStore::remember_prepared(const std::string& recipe_id) {
  const MutexLock lock(impl_->mutex);
  remember_in(impl_->database, recipe_id);
}

std::string JobStore::prepared_recipe() const {
  const MutexLock lock(impl_->read_mutex);
  Statement query(impl_->reader, "SELECT recipe FROM prepared_recipe");
  return query.step() ? query.text(0) : std::string();
}

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
    if (job.state == JobState::kCompleted) --impl_->results;
  }
  return impl_->waiting;
}

RecipeVersions& JobStore::recipe_versions() noexcept { return impl_->recipes; }

CurveWidthTable& JobStore::curve_widths() noexcept { return impl_->widths; }

ObjectiveTable& JobStore::objectives() noexcept { return impl_->objectives; }

AuditTable& JobStore::audit() noexcept { return impl_->audit; }
EvaluationTable& JobStore::evaluations() noexcept { return impl_->evaluations; }
ResultTable& JobStore::results() noexcept { return impl_->on_disk; }
const JobHistory& JobStore::history() const noexcept { return impl_->history; }

const std::vector<std::string>& JobStore::interrupted_by_start() const noexcept { return impl_->interrupted; }

const std::filesystem::path& JobStore::file() const noexcept { return impl_->file; }

std::int64_t JobStore::epoch() const noexcept { return impl_->epoch; }

}  // namespace fvd
