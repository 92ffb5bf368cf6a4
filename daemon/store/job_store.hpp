#pragma once

/// Jobs on disk: what was accepted stays known, whatever happens to the process.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "daemon/job_service.hpp"

namespace fvd {

/// A job with what its end left behind.
struct StoredJob {
  JobStatus status;
  std::string result_dir;
  std::string result_json;
};

/// SQLite, write-ahead log, synchronous=FULL: a call that returned is on disk. context: thread-safe.
class JobStore {
 public:
  /// Sequence numbers further back than this from the newest are refused as stale.
  static constexpr std::int64_t kSeqWindow = 1000;

  /// Opens or makes the database, counts the start, and ends jobs that were running when the last process died as
  /// failed/interrupted. Throws Error kDatabase, kStorageFull.
  explicit JobStore(const std::filesystem::path& file);
  ~JobStore();

  /// The job of the same sequence number, if the request is the same. Throws Error kSeqConflict if it is another,
  /// kSeqStale if the number is too old to be known.
  [[nodiscard]] std::optional<JobStatus> find_repeated(const JobRequest& request) const;

  /// Makes the job's row durable and gives it its id. Throws Error kDatabase, kStorageFull.
  JobStatus accept(const JobRequest& request);

  /// The job's end, durable. Throws likewise.
  void finish(const JobStatus& ended, const std::string& result_dir, const std::string& result_json);

  /// Throws Error kUnknownJob. Of a job that runs, only what was known when it was accepted.
  [[nodiscard]] StoredJob find(const JobKey& key) const;
  [[nodiscard]] std::optional<JobStatus> latest() const;
  /// The oldest ended job that was not acknowledged.
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const;
  [[nodiscard]] int unacknowledged_count() const;
  /// Returns how many remain. Throws Error kUnknownJob.
  int acknowledge(const JobKey& key);

  /// Counts the times this database was opened, from 1.
  [[nodiscard]] std::int64_t epoch() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fvd
