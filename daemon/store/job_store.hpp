#pragma once

/// Jobs on disk: what was accepted stays known, whatever happens to the process.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/recipes/recipe_versions.hpp"
#include "daemon/store/audit_table.hpp"
#include "daemon/store/curve_width_table.hpp"
#include "daemon/store/evaluation_table.hpp"
#include "daemon/store/job_history.hpp"
#include "daemon/store/job_status.hpp"
#include "daemon/store/objective_table.hpp"
#include "daemon/store/result_table.hpp"
#include "daemon/store/sequence_numbers.hpp"

namespace fvd {

/// A job with what its end left behind.
/// A call that returned is on disk (SQLite, write-ahead log, synchronous=FULL; about 0.3 ms a commit).
/// context: thread-safe. What only reads never waits for a commit.
class JobStore {
 public:
  struct Options {
    std::chrono::seconds repeat_window{600};  ///< a number is repeated as long as its job ended no longer ago
    bool start_anew = false;                  ///< a database that is gone is not missed
  };

  /// Opens or creates the database and its folder, brings the tables of an older version up to date (a copy is kept
  /// beside it), counts the start, and ends the jobs that were running when the last process died as failed with
  /// kInterrupted. An older copy of the database goes on with a higher epoch than any before, and no number that may
  /// have been used runs again. Throws Error kDatabase (also if another process holds the file, it was written by a
  /// newer version, or it is gone), kStorageFull, kStorageWrite.
  explicit JobStore(const std::filesystem::path& file) : JobStore(file, Options{}) {}
  JobStore(const std::filesystem::path& file, const Options& options);
  ~JobStore();
  JobStore(const JobStore&) = delete;
  JobStore& operator=(const JobStore&) = delete;

  /// The job of this client and sequence number if the request repeats it, nothing if the number is new; see
  /// repeated_in(). Throws Error kSeqConflict, kSeqStale.
  [[nodiscard]] std::optional<JobStatus> find_repeated(const JobRequest& request) const;

  /// Makes the job's row durable and gives the job its id: unique over all starts, sortable by time, 29 characters.
  /// request names its recipe, which is the prepared one from now on. Room for the row that ends the job is held, and
  /// an end that is kept in memory is stored first: no job is taken before. Throws Error kSeqConflict if the number is
  /// taken, kSeqStale, kDatabase, kStorageFull, kStorageWrite.
  JobStatus accept(const JobRequest& request);

  /// Makes the end of the job `ended.job_id` durable. ended.state is not kProcessing. Throws Error kUnknownJob;
  /// kDatabase and kStorageFull if the end is not on disk: it is kept in memory then and told with
  /// JobStatus::not_durable by every function here, until it could be stored. values: of its result, stored with it.
  void finish(const JobStatus& ended, const std::string& result_dir, const std::string& result_json,
              bool files_pending = false, const std::vector<StoredValue>& values = {});
  /// The files of an ended job's result as they stand now: what differs from finish() is told in result_json. Throws
  /// Error kUnknownJob, kDatabase, kStorageFull.
  void note_files(const std::string& job_id, const std::string& result_json, bool files_pending);
  /// Moves what was committed from the write-ahead log into the database's file, while commits go on. Later ones
  /// overwrite the log then: one that grows waits for the file system's journal, too, and so for whoever else writes
  /// files. To be called where nobody waits; a failure is logged, and does no harm before the log has 4 MB.
  void shorten_log() noexcept;
  /// The jobs whose results have files that are still to be made, the oldest first.
  [[nodiscard]] std::vector<StoredJob> with_pending_files() const;
  /// Stores the ends that are kept in memory. Throws Error kDatabase, kStorageFull: they are still kept.
  void store_kept_ends();

  /// Throws Error kUnknownJob. Of a running job only what was known when it was accepted.
  [[nodiscard]] StoredJob find(const JobKey& key) const;
  /// The job accepted last.
  [[nodiscard]] std::optional<JobStatus> latest() const;
  /// The client's job with the highest sequence number.
  [[nodiscard]] std::optional<JobStatus> highest(const std::string& client) const;

  /// The oldest ended job that was not acknowledged.
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const;
  /// How many there are. Kept in memory: reads no database and waits for nobody, as the next three.
  [[nodiscard]] int unacknowledged_count() const noexcept;
  /// How many of them are completed.
  [[nodiscard]] int unacknowledged_results() const noexcept;
  /// The newest number of each client; never null.
  [[nodiscard]] std::shared_ptr<const NewestSeqs> newest_seqs() const;
  /// Why the end of a job is not stored yet, its id first; empty = every end is.
  [[nodiscard]] std::string kept_end() const;
  /// Returns how many remain; repeating it changes nothing. An end that is kept in memory is stored first. Throws Error
  /// kUnknownJob, kBusy if the job has not ended, kDatabase, kStorageFull.
  int acknowledge(const JobKey& key);

  /// Remembers the recipe for jobs that name none. Throws Error kDatabase, kStorageFull.
  void remember_prepared(const std::string& recipe_id);
  /// Empty = none was prepared.
  [[nodiscard]] std::string prepared_recipe() const;

  /// In the same file; as long as the store. context: thread-safe.
  [[nodiscard]] RecipeVersions& recipe_versions() noexcept;

  /// In the same file; as long as the store. context: thread-safe.
  [[nodiscard]] CurveWidthTable& curve_widths() noexcept;

  /// In the same file; as long as the store. context: thread-safe.
  [[nodiscard]] ObjectiveTable& objectives() noexcept;
  [[nodiscard]] EvaluationTable& evaluations() noexcept;
  [[nodiscard]] ResultTable& results() noexcept;
  [[nodiscard]] AuditTable& audit() noexcept;
  [[nodiscard]] const JobHistory& history() const noexcept;

  /// The ids of the jobs that this start found running and ended: nobody was told of their ends yet.
  [[nodiscard]] const std::vector<std::string>& interrupted_by_start() const noexcept;

  [[nodiscard]] const std::filesystem::path& file() const noexcept;

  /// Counts the times this database was opened, from 1; an older copy goes on behind the newest.
  [[nodiscard]] std::int64_t epoch() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
