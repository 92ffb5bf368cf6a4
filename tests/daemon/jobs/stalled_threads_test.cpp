/// Threads that hang in the middle of their work are seen by the watchdog.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>

#include "core/runtime/thread_ticks.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/jobs/audit_log.hpp"
#include "daemon/jobs/following_files.hpp"
#include "daemon/jobs/retention.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/daemon/store/held_disk.hpp"

namespace fvd {
namespace {

using std::chrono::minutes;

/// Whether the thread will be seen to hang if it goes on as it is for so long.
bool hangs_after(const std::string& thread, HostClock::duration time) {
  const auto stalled = stalled_threads(HostClock::now() + time);
  return std::any_of(stalled.begin(), stalled.end(), [&](const StalledThread& one) { return one.name == thread; });
}

/// The first call that makes or renames something waits until it is let go.
class HeldCalls final : public FileCalls {
 public:
  int create(const std::filesystem::path& path, mode_t mode) override {
    hold();
    return FileCalls::create(path, mode);
  }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    hold();
    return FileCalls::rename(from, to);
  }
  void await() { began_.get_future().wait(); }
  void let_go() { go_.set_value(); }

 private:
  void hold() {
    if (held_.exchange(true)) return;
    began_.set_value();
    go_.get_future().wait();
  }
  std::atomic<bool> held_ = false;
  std::promise<void> began_;
  std::promise<void> go_;
};

TEST(AThreadThatHangs, IsSeenWhereItWritesTheAudit) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  test::HeldDisk disk;
  AuditLog log(store.audit());
  EXPECT_FALSE(hangs_after("fvd-audit", minutes(100))) << "it has nothing to do";
  log.note({});
  disk.await_a_write();
  EXPECT_FALSE(hangs_after("fvd-audit", minutes(1)));
  EXPECT_TRUE(hangs_after("fvd-audit", minutes(3)));
  disk.let_go();
}

TEST(AThreadThatHangs, IsSeenWhereItMakesTheFilesThatFollow) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  JobStatus job = store.accept({1, "part", "chapter"});
  AtomicDirectory directory(folder / "result");
  const FirstFiles files = write_first_files(directory, test::sample_result());
  directory.commit();
  job.state = JobState::kCompleted;
  store.finish(job, (folder / "result").string(), result_json_text(files.result), true);
  HeldCalls calls;
  const ReplacedFileCalls replaced(calls);
  FollowingFiles following(store);
  following.start();
  calls.await();
  EXPECT_FALSE(hangs_after("fvd-follow", minutes(20)));
  EXPECT_TRUE(hangs_after("fvd-follow", minutes(31)));
  calls.let_go();
  ASSERT_TRUE(following.wait_for(0, {}));
}

TEST(AThreadThatHangs, IsSeenWhereItWritesTheFirstFiles) {
  const test::ScratchDir folder;
  const ResultData data = test::sample_result();
  AtomicDirectory directory(folder / "result");
  HeldCalls calls;
  const ReplacedFileCalls replaced(calls);
  FirstFilesWriter writer(directory, data);
  calls.await();
  EXPECT_FALSE(hangs_after("fvd-files", minutes(9)));
  EXPECT_TRUE(hangs_after("fvd-files", minutes(11)));
  calls.let_go();
  (void)writer.finish();
}

TEST(AThreadThatHangs, IsSeenWhereItRemovesOldResults) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  JobStatus job = store.accept({1, "part", "chapter"});
  const auto result = (folder / "results" / job.job_id).string();
  std::filesystem::create_directories(result);
  job.state = JobState::kCompleted;
  job.ended_utc = "2020-01-01T00:00:00.000Z";
  store.finish(job, result, "{}");
  (void)store.acknowledge(ClientSeq{1});
  HeldCalls calls;
  const ReplacedFileCalls replaced(calls);
  Retention retention(store, {.keep_days = 30}, folder / "results");
  retention.start();
  calls.await();
  EXPECT_FALSE(hangs_after("fvd-retention", minutes(9)));
  EXPECT_TRUE(hangs_after("fvd-retention", minutes(11)));
  calls.let_go();
  retention.finish();
}

using AMachineThread = test::AnEngine;

TEST_F(AMachineThread, IsSeenToHangBetweenJobsAndInACommand) {
  std::promise<void> opening;
  std::promise<void> go;
  hold_camera_opening(opening, go);
  open();
  opening.get_future().wait();
  EXPECT_FALSE(hangs_after("fvd-machine", minutes(1)));
  EXPECT_TRUE(hangs_after("fvd-machine", minutes(3))) << "an opening that never ends";
  go.set_value();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  test::Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  EXPECT_FALSE(hangs_after("fvd-machine", minutes(50))) << "an autofocus may have a thousand looks";
  EXPECT_TRUE(hangs_after("fvd-machine", minutes(61)));
  hold.go.set_value();
  ASSERT_TRUE(await_answer(*task));
}

}  // namespace
}  // namespace fvd
