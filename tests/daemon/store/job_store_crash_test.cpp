/// The store when the process dies, the disk fills up or the file is not what it should be.

#include <cerrno>
#include <csignal>
#include <fstream>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/store/database.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/daemon/store/broken_disk.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using ::testing::HasSubstr;

/// Runs `body` in a process of its own that then dies by SIGKILL: nothing is closed, nothing flushed.
template <typename Body>
void in_a_process_that_is_killed(Body body) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    try {
      body();
      ::raise(SIGKILL);
    } catch (...) {
    }
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << "the child failed before it could be killed";
}

TEST(JobStoreCrash, FindsAnAcceptedJobAsInterruptedAfterAKill) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "jobs.db";
  in_a_process_that_is_killed([&] {
    JobStore store(file);
    (void)store.accept({42, "part", "chapter"});
  });

  JobStore store(file);

  EXPECT_EQ(store.epoch(), 2);
  const JobStatus job = store.find(ClientSeq{42}).status;
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.error, ErrorCode::kInterrupted);
  EXPECT_THAT(job.error_message, HasSubstr("measure the part again"));
  EXPECT_EQ(store.find_repeated({42, "part", "chapter"})->job_id, job.job_id) << "never a second motion";
  EXPECT_EQ(store.next_unacknowledged()->job_id, job.job_id);
}

TEST(JobStoreCrash, KeepsAFinishedJobAfterAKill) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "jobs.db";
  in_a_process_that_is_killed([&] {
    JobStore store(file);
    JobStatus job = store.accept({42, "part", "chapter"});
    job.state = JobState::kCompleted;
    store.finish(job, "/results/42", "{\"points\":1}");
  });

  JobStore store(file);

  EXPECT_EQ(store.find(ClientSeq{42}).status.state, JobState::kCompleted);
  EXPECT_EQ(store.find(ClientSeq{42}).result_json, "{\"points\":1}");
}

TEST(JobStoreCrash, CountsEveryStartThatWasKilled) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "jobs.db";
  for (int i = 0; i < 3; ++i) in_a_process_that_is_killed([&] { const JobStore store(file); });
  EXPECT_EQ(JobStore(file).epoch(), 4);
}

TEST(JobStoreCrash, RefusesAFileThatAnotherConnectionHolds) {
  const test::ScratchDir folder;
  const JobStore first(folder.path() / "jobs.db");
  FVD_EXPECT_ERROR_SAYING(kBusy, JobStore(folder.path() / "jobs.db"), HasSubstr("another fvd"));
}

TEST(JobStoreCrash, RefusesAFileThatIsNoDatabase) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "jobs.db";
  std::ofstream(file) << std::string(8192, 'x');
  FVD_EXPECT_ERROR_SAYING(kDatabase, JobStore{file}, HasSubstr(file.string()));
}

TEST(JobStoreCrash, RefusesAnUnusableFolder) {
  const test::ScratchDir folder;
  std::ofstream(folder.path() / "file") << "not a folder";
  FVD_EXPECT_ERROR_SAYING(kStorageWrite, JobStore(folder.path() / "file" / "jobs.db"), HasSubstr("/file"));
}

TEST(JobStoreCrash, RefusesADatabaseOfANewerVersion) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "jobs.db";
  { const JobStore store(file); }
  Database(file).execute("PRAGMA user_version = 99");
  FVD_EXPECT_ERROR_SAYING(kDatabase, JobStore{file}, HasSubstr("newer"));
}

TEST(JobStoreCrash, SaysThatTheDiskIsFullAndWorksAgainWhenItIsNot) {
  const test::ScratchDir folder;
  JobStore store(folder.path() / "jobs.db");
  {
    const test::BrokenDisk full(ENOSPC);
    FVD_EXPECT_ERROR(kStorageFull, (void)store.accept({1, "part", "chapter"}));
  }
  FVD_EXPECT_ERROR(kUnknownJob, (void)store.find(ClientSeq{1}));

  EXPECT_NO_THROW((void)store.accept({1, "part", "chapter"}));
}

TEST(JobStoreCrash, KeepsAnEndThatTheDiskDoesNotTakeAndStoresItLater) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "jobs.db";
  {
    JobStore store(file);
    JobStatus job = store.accept({1, "part", "chapter"});
    job.state = JobState::kCompleted;
    {
      const test::BrokenDisk broken(EIO);
      FVD_EXPECT_ERROR(kDatabase, store.finish(job, "dir", "{}"));
      EXPECT_EQ(store.find(ClientSeq{1}).status.state, JobState::kCompleted) << "what happened is told";
      EXPECT_THAT(store.find(ClientSeq{1}).status.not_durable, HasSubstr("database"));
      EXPECT_EQ(store.find(ClientSeq{1}).result_json, "{}");
      EXPECT_EQ(store.latest()->state, JobState::kCompleted);
      EXPECT_EQ(store.highest(kDefaultClient)->state, JobState::kCompleted);
      EXPECT_EQ(store.next_unacknowledged()->job_id, job.job_id);
      EXPECT_EQ(store.unacknowledged_count(), 1);
      FVD_EXPECT_ERROR_SAYING(kDatabase, (void)store.accept({2, "part", "chapter"}), HasSubstr(job.job_id));
      FVD_EXPECT_ERROR(kDatabase, store.store_kept_ends());
    }
    store.store_kept_ends();
    EXPECT_EQ(store.find(ClientSeq{1}).status.not_durable, "");
    EXPECT_EQ(store.unacknowledged_count(), 1) << "counted once";
  }
  EXPECT_EQ(JobStore(file).find(ClientSeq{1}).status.state, JobState::kCompleted);
}

TEST(JobStoreCrash, FindsAJobWhoseEndWasNeverStoredAsInterrupted) {
  const test::ScratchDir folder;
  const auto file = folder.path() / "jobs.db";
  {
    JobStore store(file);
    JobStatus job = store.accept({1, "part", "chapter"});
    job.state = JobState::kCompleted;
    const test::BrokenDisk broken(EIO);
    FVD_EXPECT_ERROR(kDatabase, store.finish(job, "dir", "{}"));
  }
  EXPECT_EQ(JobStore(file).find(ClientSeq{1}).status.error, ErrorCode::kInterrupted) << "nothing half done";
}

}  // namespace
}  // namespace fvd
