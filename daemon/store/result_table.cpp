#include "daemon/store/result_table.hpp"

#include "core/base/error.hpp"
#include "daemon/store/job_rows.hpp"

namespace fvd {

std::vector<StoredJob> ResultTable::on_disk() const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database,
                 "SELECT job_id, ended_utc, acknowledged, files_pending FROM jobs "
                 "WHERE result_dir <> '' AND removed_utc = '' ORDER BY number");
  std::vector<StoredJob> jobs;
  while (rows.step()) {
    StoredJob job;
    job.status.job_id = rows.text(0);
    job.status.ended_utc = rows.text(1);
    job.status.acknowledged = rows.integer(2) != 0;
    job.files_pending = rows.integer(3) != 0;
    jobs.push_back(std::move(job));
  }
  return jobs;
}

std::vector<JobStatus> ResultTable::without_result() const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database,
                 "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE state IN ('failed', 'aborted') AND result_dir = ''");
  std::vector<JobStatus> jobs;
  while (rows.step()) jobs.push_back(read_job_row(rows).status);
  return jobs;
}

std::uint64_t ResultTable::count_of_interrupted() const {
  const MutexLock lock(reader_.mutex);
  Statement count(reader_.database, "SELECT count(*) FROM jobs WHERE error = ?");
  count.bind(error_name(ErrorCode::kInterrupted));
  return count.step() ? static_cast<std::uint64_t>(count.integer(0)) : 0;
}

bool ResultTable::mark_removed(const std::string& job_id) {
  const MutexLock lock(writer_.mutex);
  Statement(writer_.database,
            "UPDATE jobs SET removed_utc = ?, result_json = '' "
            "WHERE job_id = ? AND acknowledged = 1 AND removed_utc = ''")
      .bind(utc_now())
      .bind(job_id)
      .run();
  return sqlite3_changes(writer_.database.handle()) > 0;
}

std::vector<std::string> ResultTable::removed_last() const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database,
                 "SELECT job_id FROM jobs WHERE removed_utc <> '' ORDER BY removed_utc DESC LIMIT 100");
  std::vector<std::string> ids;
  while (rows.step()) ids.push_back(rows.text(0));
  return ids;
}

}  // namespace fvd
