/// What a job does not wait for before the stage is told to move.

#include <atomic>
#include <cerrno>
#include <filesystem>

#include <gmock/gmock.h>

#include "daemon/export/file_calls.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/jobs/engine_bench.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;

/// Looks how far the stage is when the first directory is made, or makes none.
class WatchedDirectories final : public FileCalls {
 public:
  explicit WatchedDirectories(const std::atomic<int>& moves) : moves_(moves) {}
  int make_directory(const fs::path& path) override {
    int none = -1;
    moves_before.compare_exchange_strong(none, moves_);
    if (!fails) return FileCalls::make_directory(path);
    errno = EIO;
    return -1;
  }
  std::atomic<int> moves_before{-1};
  std::atomic<bool> fails{false};

 private:
  const std::atomic<int>& moves_;
};

class TheFirstMotion : public test::AnEngine {
 protected:
  WatchedDirectories calls_{bench_.moves};
  ReplacedFileCalls replaced_{calls_};
};

TEST_F(TheFirstMotion, ComesBeforeTheDirectoryOfTheResult) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kCompleted);
  EXPECT_GE(calls_.moves_before, 2) << "take-up and first slice";
  EXPECT_TRUE(fs::exists(folder_.path() / "results" / machine().snapshot()->job->job_id / "result.json"));
}

TEST_F(TheFirstMotion, IsOfAJobThatFailsWithTheReasonWhereItsDirectoryCannotBeMade) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  calls_.fails = true;
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_end_of(1));
  const JobStatus job = *machine().snapshot()->job;
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.error, ErrorCode::kStorageWrite) << job.error_message;
  EXPECT_THAT(job.error_message, testing::HasSubstr("create directory"));
  EXPECT_TRUE(job.acquired) << "the stage stands";
  calls_.fails = false;
  jobs().start({2, "a", "part"});
  ASSERT_TRUE(await_end_of(2));
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kCompleted);
}

}  // namespace
}  // namespace fvd
