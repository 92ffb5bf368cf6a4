/// What clients see of a disk that cannot keep results, and of a start after one that was cut off.

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/export/file_calls.hpp"
#include "daemon/jobs/reconcile_results.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/daemon/store/broken_disk.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using test::AnEngine;
using ::testing::HasSubstr;

class Storage : public AnEngine {
 protected:
  [[nodiscard]] bool await_ready(bool ready) {
    return await([ready](const MachineStatus& now) { return now.signals.ready == ready; });
  }
  fs::path aside_ = folder_.path() / "aside";
};

TEST_F(Storage, ThatIsGoneMakesTheMachineNotReadyUntilItIsBack) {
  open();
  for (const char* name : {"fvd.sqlite", "results"}) {
    ASSERT_TRUE(await_ready(true)) << name;
    fs::rename(folder_.path() / name, aside_);
    ASSERT_TRUE(await_ready(false)) << name;
    const auto now = machine().snapshot();
    EXPECT_EQ(now->state, ScanState::kError);
    EXPECT_THAT(now->error_message, HasSubstr(name));
    EXPECT_TRUE(now->signals.part_release) << "the stage stands all the same";
    EXPECT_THROW(jobs().start({1, "a", "part"}), Error);
    fs::rename(aside_, folder_.path() / name);
  }
  ASSERT_TRUE(await_ready(true));
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kCompleted);
}

TEST_F(Storage, ThatWasExchangedJustNowTakesNoJobEvenBeforeAnybodyWasTold) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  test::Hold hold;  // nobody looks after the disk meanwhile
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  fs::rename(folder_.path() / "fvd.sqlite", aside_);
  FVD_EXPECT_ERROR_SAYING(kDatabase, jobs().start({1, "a", "part"}), HasSubstr("fvd.sqlite"));
  fs::rename(aside_, folder_.path() / "fvd.sqlite");
  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate);
  hold.go.set_value();
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(Storage, ThatCannotTakeAnEndMakesTheMachineNotReadyWhileTheEndIsToldAsItIs) {
  std::unique_ptr<test::BrokenDisk> broken;
  open([&](AtomicDirectory& directory, const ResultData& acquired, FirstFilesWriter* begun) {
    JobResult result = store_result(directory, acquired, begun);
    broken = std::make_unique<test::BrokenDisk>(EIO);
    return result;
  });
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kCompleted);
  EXPECT_FALSE(machine().snapshot()->signals.ready);
  EXPECT_EQ(machine().snapshot()->error, ErrorCode::kDatabase);
  broken->mend();
  ASSERT_TRUE(await_ready(true));
  EXPECT_EQ(store_->find(ClientSeq{1}).status.state, JobState::kCompleted);
  engine_->finish();
  broken.reset();
}

TEST_F(Storage, ThatHasNoRoomForTheResultRefusesTheJobBeforeAnythingMoves) {
  const fs::path results = folder_.path() / "results";
  if (::mount("tmpfs", results.c_str(), "tmpfs", 0, "size=17m") != 0) GTEST_SKIP() << "no disk can be mounted here";
  open();
  EXPECT_TRUE(await_ready(true));
  FVD_EXPECT_ERROR_SAYING(kStorageFull, jobs().start({1, "a", "part"}), HasSubstr("its result takes up to"));
  EXPECT_FALSE(machine().snapshot()->job.has_value());
  engine_->finish();
  EXPECT_EQ(::umount2(results.c_str(), MNT_DETACH), 0);
}

TEST_F(Storage, KeepsThePreparedRecipeOverARestart) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  jobs().prepare("part");
  machine().on_change({});
  engine_.reset();
  store_.reset();
  store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");
  open();
  ASSERT_TRUE(await_state(ScanState::kReady));
  EXPECT_EQ(machine().snapshot()->recipe, "part");
  EXPECT_FALSE(jobs().start({1, "a", ""}).duplicate);
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(Storage, RefusesTheNumberOfAJobThatARestartInterrupted) {
  (void)store_->accept({7, "P-1", "part"});
  store_.reset();
  store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");
  open();
  ASSERT_TRUE(await([](const MachineStatus& now) { return now.signals.ready; }));
  EXPECT_FALSE(machine().snapshot()->job->acquired) << "nobody saw the stage stand";
  EXPECT_EQ(machine().snapshot()->ended.interrupted, 1U);
  EXPECT_EQ(machine().snapshot()->ended.failed, 0U) << "it ended before this start";
  FVD_EXPECT_ERROR_SAYING(kInterrupted, jobs().start({7, "P-1", "part"}), HasSubstr("new sequence number"));
  EXPECT_EQ(machine().snapshot()->newest_seqs->at("plc"), 7);
}

TEST_F(Storage, TellsResultsThatWaitWhateverTheNewestJobCameTo) {
  config_.rpc.fifo_results = 1;
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  for (const std::int64_t seq : {1, 2}) {
    jobs().start({seq, "a", "part"});
    ASSERT_TRUE(await_end_of(seq));
  }
  EXPECT_TRUE(machine().snapshot()->overrun);
  services_->results.acknowledge(ClientSeq{2});
  EXPECT_TRUE(machine().snapshot()->result_valid) << "the first still waits";
  EXPECT_FALSE(machine().snapshot()->overrun);
  services_->results.acknowledge(ClientSeq{1});
  EXPECT_FALSE(machine().snapshot()->result_valid);
}

/// Results whose process was killed between the folder's rename and the job's row.
class AKillBetweenFolderAndRow : public testing::Test {
 protected:
  AKillBetweenFolderAndRow() {
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        JobStore store(folder_ / "fvd.sqlite");
        ResultData data = test::sample_result();
        data.job_id = store.accept({1, "part", "chapter"}).job_id;
        fs::create_directory(folder_ / "results");
        AtomicDirectory directory(folder_ / "results" / data.job_id);
        (void)store_result(directory, data);
        ::raise(SIGKILL);
      } catch (...) {
      }
      ::_exit(1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    killed_ = WIFSIGNALED(status);
    store_ = std::make_unique<JobStore>(folder_ / "fvd.sqlite");
  }
  void SetUp() override {
    ASSERT_TRUE(killed_);
    job_ = store_->find(ClientSeq{1}).status;
    ASSERT_EQ(job_.error, ErrorCode::kInterrupted);
  }
  test::ScratchDir folder_;
  bool killed_ = false;
  std::unique_ptr<JobStore> store_;
  JobStatus job_;
};

TEST_F(AKillBetweenFolderAndRow, LeavesTheJobItsWholeResult) {
  const Reconciled done = reconcile_results(*store_, folder_ / "results");
  EXPECT_EQ(done.adopted, 1);
  EXPECT_EQ(done.removed, 0);
  const StoredJob now = store_->find(ClientSeq{1});
  EXPECT_EQ(now.status.state, JobState::kCompleted);
  EXPECT_EQ(now.status.error, std::nullopt);
  EXPECT_EQ(now.status.slices_planned, 3);
  EXPECT_FALSE(now.status.acquired) << "nobody knows whether standstill was measured";
  EXPECT_EQ(now.result_json, test::read_text(fs::path(now.result_dir) / "result.json"));
  EXPECT_TRUE(now.files_pending) << "the files that follow are still to be made";
  EXPECT_EQ(store_->unacknowledged_results(), 1);
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").adopted, 0) << "once";
}

TEST_F(AKillBetweenFolderAndRow, LeavesNothingOfAFolderThatIsNotWhole) {
  const fs::path result = folder_ / "results" / job_.job_id;
  fs::resize_file(result / "height.tiff", 10);
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").removed, 1);
  EXPECT_FALSE(fs::exists(result));
  EXPECT_EQ(store_->find(ClientSeq{1}).status.error, ErrorCode::kInterrupted);
}

TEST_F(AKillBetweenFolderAndRow, LeavesTheJobAResultHoweverLongItsTextIs) {
  std::ofstream(folder_ / "results" / job_.job_id / "result.json", std::ios::app)
      << std::string(std::size_t{9} << 20U, ' ');
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").adopted, 1);
  EXPECT_TRUE(fs::exists(store_->find(ClientSeq{1}).result_dir));
}

TEST_F(AKillBetweenFolderAndRow, LeavesAResultThatCannotBeReadForTheNextStart) {
  const fs::path text = folder_ / "results" / job_.job_id / "result.json";
  fs::rename(text, folder_ / "whole");
  for (const char* unreadable : {"/proc/self/mem", "result.json"}) {  // EIO, ELOOP
    fs::create_symlink(unreadable, text);
    const Reconciled done = reconcile_results(*store_, folder_ / "results");
    EXPECT_EQ(done.adopted + done.removed + done.set_aside, 0) << unreadable;
    ASSERT_TRUE(fs::is_symlink(text)) << unreadable;
    fs::remove(text);
  }
  fs::rename(folder_ / "whole", text);
  const fs::path part = folder_ / "results" / job_.job_id / "height.tiff";
  fs::rename(part, folder_ / "part");
  fs::create_symlink("height.tiff", part);  // the disk does not tell its size
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").removed, 0);
  fs::remove(part);
  fs::rename(folder_ / "part", part);

  store_.reset();
  store_ = std::make_unique<JobStore>(folder_ / "fvd.sqlite");
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").set_aside, 1);
  EXPECT_TRUE(fs::exists(folder_ / "set-aside" / job_.job_id / "result.json"));
}

TEST_F(AKillBetweenFolderAndRow, LeavesAResultOfANewerVersionToThatVersion) {
  const fs::path text = folder_ / "results" / job_.job_id / "result.json";
  const std::string newer = R"({"format": 1000, "what": "nobody knows"})";
  test::write_text(text, newer);
  const Reconciled done = reconcile_results(*store_, folder_ / "results");
  EXPECT_EQ(done.set_aside, 1);
  EXPECT_EQ(done.removed, 0);
  EXPECT_EQ(test::read_text(folder_ / "set-aside" / job_.job_id / "result.json"), newer);
  EXPECT_TRUE(fs::exists(folder_ / "set-aside" / job_.job_id / "height.tiff"));
  EXPECT_EQ(store_->find(ClientSeq{1}).status.error, ErrorCode::kInterrupted);
}

TEST_F(AKillBetweenFolderAndRow, LeavesNothingOfAFolderWhoseTextIsCutOff) {
  const fs::path text = folder_ / "results" / job_.job_id / "result.json";
  fs::resize_file(text, fs::file_size(text) / 2);
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").removed, 1);
  EXPECT_FALSE(fs::exists(folder_ / "set-aside"));
}

TEST_F(AKillBetweenFolderAndRow, LeavesNothingOfAFolderWithoutItsText) {
  fs::remove(folder_ / "results" / job_.job_id / "result.json");
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").removed, 1);
  EXPECT_TRUE(fs::is_empty(folder_ / "results"));
}

TEST_F(AKillBetweenFolderAndRow, ChangesNothingThatWasToldAndAcknowledged) {
  (void)store_->acknowledge(ClientSeq{1});
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").set_aside, 1);
  EXPECT_EQ(store_->find(ClientSeq{1}).status.error, ErrorCode::kInterrupted);
}

TEST_F(AKillBetweenFolderAndRow, ChangesNothingThatAStartBeforeTold) {
  store_.reset();
  store_ = std::make_unique<JobStore>(folder_ / "fvd.sqlite");
  const Reconciled done = reconcile_results(*store_, folder_ / "results");
  EXPECT_EQ(done.adopted, 0);
  EXPECT_EQ(done.set_aside, 1);
  EXPECT_EQ(store_->find(ClientSeq{1}).status.error, ErrorCode::kInterrupted);
  EXPECT_TRUE(fs::is_empty(folder_ / "results"));
  EXPECT_TRUE(fs::exists(folder_ / "set-aside" / job_.job_id / "result.json")) << "nothing measured is lost";
}

TEST_F(AKillBetweenFolderAndRow, ChangesNothingOfAJobThatWasToldAsFailed) {
  JobStatus failed = store_->accept({2, "part", "chapter"});
  fs::rename(folder_ / "results" / job_.job_id, folder_ / "results" / failed.job_id);  // it could not be taken back
  failed.state = JobState::kFailed;
  failed.error = ErrorCode::kStorageWrite;
  store_->finish(failed, "", "");
  EXPECT_EQ(reconcile_results(*store_, folder_ / "results").removed, 1) << "the result of another job";
  EXPECT_EQ(store_->find(ClientSeq{2}).status.error, ErrorCode::kStorageWrite);
  EXPECT_TRUE(fs::is_empty(folder_ / "results"));
}

TEST_F(AKillBetweenFolderAndRow, LeavesARefusedEvaluationItsFilesWhereItsRowCameBack) {
  const fs::path results = folder_ / "results";
  StoredEvaluation row;
  row.id = job_.job_id + "-e1";
  row.job_id = job_.job_id;
  row.number = 1;
  store_->evaluations().add(row);
  const std::string second = job_.job_id + "-e2";
  for (const std::string& id : {row.id, second}) fs::create_directory(results / refused_evaluation(id));
  restore_refused_evaluations(*store_, results);
  EXPECT_TRUE(fs::exists(results / row.id));
  EXPECT_FALSE(fs::exists(results / second));
  EXPECT_EQ(remove_abandoned_directories(results), 1U) << "what has no row goes, as all that is not finished";
}

TEST_F(AKillBetweenFolderAndRow, LeavesFoldersOfJobsAndEvaluationsThatTheDatabaseDoesNotKnow) {
  const fs::path results = folder_ / "results";
  fs::create_directory(results / "20260101T000000Z-00001-000001");
  fs::create_directory(results / (job_.job_id + "-e1"));
  (void)reconcile_results(*store_, results);
  EXPECT_TRUE(fs::exists(results / "20260101T000000Z-00001-000001")) << "a database that was put back may lack its row";
  EXPECT_TRUE(fs::exists(results / (job_.job_id + "-e1"))) << "and an evaluation's, which was told";
}

}  // namespace
}  // namespace fvd
