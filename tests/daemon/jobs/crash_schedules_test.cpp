/// A result on its way to the disk, cut off by a power cut at every call, with every part of what was not synced lost.

#include <cstdlib>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include "daemon/export/result_json.hpp"
#include "daemon/export/sha256.hpp"
#include "daemon/jobs/follow_result.hpp"
#include "daemon/jobs/reconcile_results.hpp"
#include "daemon/jobs/result_pipeline.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/jobs/crash_disk.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;

/// In tests/bench/service/crash.sh more.
std::size_t schedules() {
  const char* const asked = std::getenv("FVD_CRASH_SCHEDULES");
  return asked != nullptr ? std::strtoul(asked, nullptr, 10) : 300;
}

class ACrash : public testing::Test {
 protected:
  ACrash() : level_(spdlog::get_level()) { spdlog::set_level(spdlog::level::off); }
  ~ACrash() override { spdlog::set_level(level_); }

  /// A job from its acceptance to the last of the files that follow; what the database was is kept at each mark.
  void record() {
    fs::create_directories(results_);
    JobStore store(state_ / "fvd.sqlite");
    JobStatus job = store.accept({1, "part", "chapter"});
    ResultData data = test::sample_result();
    data.job_id = job.job_id;
    keep_database();
    const ReplacedFileCalls replaced(disk_);
    AtomicDirectory directory(results_ / data.job_id);
    JobResult result = store_result(directory, data);
    job.state = JobState::kCompleted;
    store.finish(job, result.directory, result.text, result.files_pending);
    disk_.mark();
    keep_database();
    const FollowedResult followed =
        follow_result({data.job_id, result.directory, result.text, std::move(result.written)}, {});
    store.note_files(data.job_id, followed.text, followed.pending);
    disk_.mark();
    keep_database();
    ASSERT_FALSE(followed.pending) << followed.reason;
  }

  /// What is wrong after a power cut within the first n calls; empty = nothing.
  [[nodiscard]] std::string violation(std::size_t n, std::mt19937& dice) {
    fs::remove_all(state_);
    const int rows = disk_.marks_within(n);
    fs::copy(kept_ / std::to_string(rows), state_);
    fs::create_directories(results_);
    disk_.leave(n, dice);
    remove_abandoned_directories(results_);
    JobStore store(state_ / "fvd.sqlite");
    (void)reconcile_results(store, results_);
    const StoredJob job = store.find(ClientSeq{1});
    const bool completed = job.status.state == JobState::kCompleted;
    if (!completed && job.status.error != ErrorCode::kInterrupted)
      return "the job is neither completed nor interrupted";
    if (rows > 0 && !completed) return "a result that was told is lost";
    if (!completed) return fs::is_empty(results_) ? "" : "an interrupted job left something";
    if (std::distance(fs::directory_iterator(results_), {}) != 1) return "there is more than the result";
    return what_lacks(job);
  }

 private:
  void keep_database() {
    const fs::path copy = kept_ / std::to_string(copies_++);
    fs::create_directories(copy);
    for (const auto& entry : fs::directory_iterator(state_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("fvd.") && !name.ends_with("-shm") && !name.ends_with(".reserve")) {
        fs::copy(entry.path(), copy / name);
      }
    }
  }
  [[nodiscard]] static std::string what_lacks(const StoredJob& job) {
    for (const std::string& text : {job.result_json, test::read_text(fs::path(job.result_dir) / "result.json")}) {
      for (const ResultFile& file : read_result_json(text).files) {
        if (file.state != FileState::kWritten) continue;
        const std::string bytes = test::read_text(fs::path(job.result_dir) / file.name);
        if (bytes.size() != file.size_bytes) return file.name + " is not whole";
        if (!file.sha256.empty() && sha256_of(bytes) != file.sha256) return file.name + " has other bytes";
      }
    }
    return {};
  }

  const spdlog::level::level_enum level_;
  int copies_ = 0;
  test::ScratchDir folder_;
  const fs::path kept_ = folder_ / "kept";
  const fs::path state_ = folder_ / "state";

 protected:
  const fs::path results_ = state_ / "results";
  test::CrashDisk disk_{results_};
};

TEST_F(ACrash, LeavesAWholeResultOrNone) {
  ASSERT_NO_FATAL_FAILURE(record());
  ASSERT_GT(disk_.calls(), 40U);
  std::size_t violations = 0;
  for (std::size_t schedule = 0; schedule < schedules(); ++schedule) {
    std::mt19937 dice(static_cast<std::mt19937::result_type>(schedule));
    const std::size_t n = schedule % (disk_.calls() + 1);
    const std::string problem = violation(n, dice);
    EXPECT_EQ(problem, "") << "schedule " << schedule << ", after " << n << " of " << disk_.calls() << " calls";
    if (!problem.empty()) ++violations;
  }
  std::cout << "{\"crash_schedules\": " << schedules() << ", \"crash_violations\": " << violations << "}" << std::endl;
}

TEST_F(ACrash, IsSeenToBreakAResultThatIsNotSynced) {
  // The disk itself: without a sync anything may be lost.
  fs::create_directories(results_);
  {
    const ReplacedFileCalls replaced(disk_);
    const int fd = disk_.create(results_ / "file", 0644);
    ASSERT_EQ(disk_.write(fd, "abcd", 4), 4);
    disk_.close(fd);
  }
  bool lost = false;
  bool cut = false;
  bool whole = false;
  for (unsigned seed = 0; seed < 100; ++seed) {
    fs::remove_all(results_);
    std::mt19937 dice(seed);
    disk_.leave(disk_.calls(), dice);
    const std::string left = test::read_text(results_ / "file");
    lost = lost || left.empty();
    cut = cut || left == "ab";
    whole = whole || left == "abcd";
  }
  EXPECT_TRUE(lost && cut && whole);
}

}  // namespace
}  // namespace fvd
