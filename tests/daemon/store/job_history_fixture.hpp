#pragma once

/// A database with jobs and their values, and its history.

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/store/database.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {

inline StoredValue height_of(double value_um) {
  return {"step", "height_um", value_um, 0.01, 0.02, 49.0, std::nullopt, "pass"};
}

/// A hundred thousand jobs, of which every hundredth has another recipe, and every tenth failed.
inline constexpr const char* kManyJobs =
    "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 100000) "
    "INSERT INTO jobs (job_id, seq, part_id, recipe, state, error, verdict, ended_utc) "
    "SELECT 'job-' || i, i, 'P-' || (i % 1000), CASE WHEN i % 100 = 0 THEN 'rare' ELSE 'often' END, "
    "CASE WHEN i % 10 = 3 THEN 'failed' ELSE 'completed' END, CASE WHEN i % 10 = 3 THEN 'camera_frames_lost' ELSE '' "
    "END, "
    "CASE WHEN i % 10 = 3 THEN '' ELSE 'pass' END, strftime('%Y-%m-%dT%H:%M:%fZ', 1700000000 + 60 * i, 'unixepoch') "
    "FROM n";
inline constexpr const char* kTheirValues =
    "INSERT INTO job_values (number, measurement, name, value, verdict) SELECT number, 'step', 'height_um', number, '' "
    "FROM jobs";

class AJobHistory : public ::testing::Test {
 protected:
  JobStatus accept(std::int64_t seq, const std::string& part = "part", const std::string& recipe = "chapter",
                   const std::string& client = "plc") {
    return store_->accept({seq, part, recipe, client});
  }
  void finish(JobStatus job, const std::string& verdict = "pass", const std::string& ended_utc = "",
              const std::vector<StoredValue>& values = {}) {
    job.state = JobState::kCompleted;
    job.verdict = verdict;
    job.ended_utc = ended_utc;
    store_->finish(job, "dir", "{}", false, values);
  }
  [[nodiscard]] std::vector<std::int64_t> numbers(const JobFilter& filter, int most = 100) const {
    std::vector<std::int64_t> numbers;
    for (const JobStatus& job : store_->history().page(filter, 0, most).jobs) numbers.push_back(job.request.seq);
    return numbers;
  }
  /// All that fit, part by part.
  [[nodiscard]] std::vector<std::int64_t> all_numbers(const JobFilter& filter) const {
    std::vector<std::int64_t> numbers;
    JobPage page;
    do {
      page = store_->history().page(filter, page.next, 500);
      for (const JobStatus& job : page.jobs) numbers.push_back(job.request.seq);
    } while (page.next != 0);
    return numbers;
  }
  [[nodiscard]] std::vector<ValuePoint> heights(const std::string& recipe = "", int most = 100) const {
    return store_->history().values({"step", "height_um", recipe, most}).points;
  }
  void fill(std::initializer_list<const char*> statements) {
    store_.reset();
    {
      Database database(file_);
      for (const char* sql : statements) database.execute(sql);
    }
    store_ = std::make_unique<JobStore>(file_);
  }
  /// All lines of the plan of a statement of the newest version.
  [[nodiscard]] std::string plan_of(const char* sql) {
    store_.reset();
    const Database database(file_);
    const std::string explained = std::string("EXPLAIN QUERY PLAN ") + sql;
    Statement rows(database, explained.c_str());
    std::string plan;
    while (rows.step()) plan += rows.text(3) + "\n";
    return plan;
  }

  test::ScratchDir folder_;
  std::filesystem::path file_ = folder_ / "fvd.sqlite";
  std::unique_ptr<JobStore> store_ = std::make_unique<JobStore>(file_);
};

}  // namespace fvd
