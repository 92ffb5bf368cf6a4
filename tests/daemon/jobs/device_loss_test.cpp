/// Devices that are lost, disks that are full: at every point the job or the command ends, is told, and the machine
/// says why it is not ready.

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/jobs/device_commands.hpp"
#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/daemon/store/broken_disk.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using test::AnEngine;
using ::testing::HasSubstr;
using T = sim::TriggerOutcome;

class ACameraLossAtSlice : public AnEngine, public testing::WithParamInterface<int> {};

TEST_P(ACameraLossAtSlice, EndsTheJobAndLeadsToErrorDirectly) {
  bench_.script.assign(static_cast<std::size_t>(GetParam()), T::kFrame);
  bench_.script.push_back(T::kDisconnect);
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  unplug_camera_for_good();
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_end_of(1));
  const auto now = machine().snapshot();
  EXPECT_EQ(now->job->state, JobState::kFailed);
  EXPECT_EQ(now->job->error, ErrorCode::kCameraDisconnected);
  EXPECT_EQ(state_behind_executing(), ScanState::kError);
  EXPECT_EQ(now->error, ErrorCode::kCameraDisconnected);
  EXPECT_TRUE(now->signals.part_release) << "the axis stands, and that was measured";
  EXPECT_EQ(store_->find(ClientSeq{1}).status.error, ErrorCode::kCameraDisconnected);
}

INSTANTIATE_TEST_SUITE_P(OfFive, ACameraLossAtSlice, testing::Range(0, 5));

class AStageLossAtMove : public AnEngine, public testing::WithParamInterface<int> {};

TEST_P(AStageLossAtMove, EndsTheJobAndHoldsThePart) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  bench_.moves_until_lost = GetParam();
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_end_of(1));
  const auto now = machine().snapshot();
  EXPECT_EQ(now->job->state, JobState::kFailed);
  EXPECT_EQ(now->job->error, ErrorCode::kStageDisconnected);
  EXPECT_EQ(state_behind_executing(), ScanState::kError);
  EXPECT_FALSE(now->signals.part_release) << "nobody knows whether it moves";
  EXPECT_FALSE(now->job->acquired) << "a client moves the part when it is true";
  EXPECT_FALSE(store_->find(JobKey{now->job->job_id}).status.acquired) << "and after a restart";
  {
    const std::lock_guard lock(bench_.mutex);
    bench_.axis_plugged = true;
  }
  ASSERT_TRUE(await_state(ScanState::kInitialized)) << "it is opened anew by itself";
  EXPECT_TRUE(signals().part_release);
}

/// A scan whose slices are good and whose stage is not known to rest after it.
class AGoodScanWithoutRest : public AnEngine {
 protected:
  void run_it() {
    open();
    ASSERT_TRUE(await_state(ScanState::kInitialized));
    jobs().start({1, "a", "part"});
    ASSERT_TRUE(await_end_of(1));
    const auto now = machine().snapshot();
    EXPECT_EQ(now->job->state, JobState::kCompleted);
    EXPECT_FALSE(now->job->acquired);
    EXPECT_FALSE(now->signals.part_release);
    EXPECT_EQ(state_behind_executing(), ScanState::kError) << "not ready";
    EXPECT_FALSE(store_->find(JobKey{now->job->job_id}).status.acquired) << "and after a restart";
  }
};

TEST_F(AGoodScanWithoutRest, EndsTheJobWhenItsStageIsLostMeanwhile) {
  bench_.lost_at_rest = true;
  bench_.moves_until_rest = 5;  // the last slice's
  run_it();
  bench_.lost_at_rest = false;
  {
    const std::lock_guard lock(bench_.mutex);
    bench_.axis_plugged = true;
  }
  ASSERT_TRUE(await_state(ScanState::kInitialized)) << "it is opened anew";
}

TEST_F(AGoodScanWithoutRest, HoldsThePartUntilTheStageStands) {
  bench_.moves_until_restless = 5;  // the last slice's
  bench_.stop_works = false;
  run_it();
  EXPECT_GE(bench_.stops, 1);
  bench_.stop_works = true;
  ASSERT_TRUE(await([](const MachineStatus& status) { return status.signals.part_release; }));
}

INSTANTIATE_TEST_SUITE_P(OfSix, AStageLossAtMove, testing::Range(0, 6));  // the take-up, then five slices

TEST_F(AnEngine, FailsAJobWhoseCameraIsGoneBeforeItBegins) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  test::Hold hold;
  const auto task = tasks().submit(
      [&hold](const Devices& devices, std::stop_token) -> std::string {
        hold.began.set_value();
        hold.go.get_future().wait_for(std::chrono::seconds(10));
        (void)devices;
        throw Error(ErrorCode::kCameraDisconnected, "pulled");
      },
      TaskMotion::kMoves);
  hold.began.get_future().wait();
  unplug_camera_for_good();
  jobs().start({1, "a", "part"});
  hold.go.set_value();
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(task->outcome()->error, ErrorCode::kCameraDisconnected);
  EXPECT_EQ(machine().snapshot()->job->error, ErrorCode::kCameraDisconnected);
  EXPECT_EQ(state_behind_executing(), ScanState::kError);
}

TEST_F(AnEngine, AnswersACommandWhoseStageIsLostAndGoesToErrorDirectly) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  bench_.moves_until_lost = 0;
  const auto task = tasks().submit(move_work(Micrometers{10.0}), TaskMotion::kMoves);
  ASSERT_TRUE(await_answer(*task));
  EXPECT_EQ(task->outcome()->error, ErrorCode::kStageDisconnected);
  EXPECT_EQ(machine().snapshot()->state, ScanState::kError) << "the state comes before the answer";
  EXPECT_EQ(state_behind_executing(), ScanState::kError);
  EXPECT_FALSE(signals().part_release);
}

TEST_F(AnEngine, AnswersACommandWhoseCameraIsLost) {
  bench_.script = {T::kDisconnect};
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  unplug_camera_for_good();
  const auto task = tasks().submit(snap_work(CameraSettings{}), TaskMotion::kNone);
  ASSERT_TRUE(await_answer(*task));
  EXPECT_EQ(task->outcome()->error, ErrorCode::kCameraDisconnected);
  EXPECT_EQ(machine().snapshot()->state, ScanState::kError);
}

TEST_F(AnEngine, AnswersACommandThatWaitedForADeviceThatIsMissing) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  bench_.moves_until_lost = 0;
  (void)tasks().submit(move_work(Micrometers{10.0}), TaskMotion::kMoves);
  ASSERT_TRUE(await_state(ScanState::kError));
  EXPECT_THROW(tasks().submit(move_work(Micrometers{20.0}), TaskMotion::kMoves), Error);
  EXPECT_THROW(jobs().start({1, "a", "part"}), Error);
}

TEST_F(AnEngine, FailsAJobWhoseResultFindsTheDiskFullAndTakesTheNext) {
  std::atomic<int> results = 0;
  open([&results](AtomicDirectory& directory, const ResultData& acquired, FirstFilesWriter* begun) -> JobResult {
    if (results++ == 0) {
      (void)begun->finish();  // but for the directory's last step
      throw Error(ErrorCode::kStorageFull, "no space is left on the device");
    }
    return store_result(directory, acquired, begun);
  });
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  const std::string first = jobs().start({1, "a", "part"}).job.job_id;
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(store_->find(first).status.error, ErrorCode::kStorageFull);
  EXPECT_EQ(store_->find(first).result_dir, "");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "results")) << "nothing half is left";
  EXPECT_EQ(machine().snapshot()->state, ScanState::kReady);
  EXPECT_TRUE(signals().part_release);

  const std::string second = jobs().start({2, "a", "part"}).job.job_id;
  ASSERT_TRUE(await_end_of(2));
  EXPECT_EQ(store_->find(second).status.state, JobState::kCompleted);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "results" / second / "result.json"));
}

/// An engine whose database finds its disk full from the end of the first job on.
class AnEngineThatCannotStoreAnEnd : public test::AnEngine {
 protected:
  void end_a_job() {
    open([this](AtomicDirectory& directory, const ResultData& acquired, FirstFilesWriter* begun) {
      JobResult result = store_result(directory, acquired, begun);
      if (!broken_) broken_.emplace(ENOSPC);
      return result;
    });
    ASSERT_TRUE(await_state(ScanState::kInitialized));
    job_id_ = jobs().start({1, "a", "part"}).job.job_id;
    ASSERT_TRUE(await_end_of(1));
  }
  void TearDown() override {
    AnEngine::TearDown();
    broken_.reset();
  }

  std::optional<test::BrokenDisk> broken_;
  std::string job_id_;
};

TEST_F(AnEngineThatCannotStoreAnEnd, TellsTheTruthWithAWarningAndTakesNoJobMeanwhile) {
  end_a_job();
  const auto now = machine().snapshot();
  EXPECT_EQ(now->job->state, JobState::kCompleted);
  EXPECT_THAT(now->job->not_durable, HasSubstr("free some disk space"));
  EXPECT_EQ(now->results_waiting, 1);
  EXPECT_NE(services_->results.stored(job_id_).result_json, "");
  EXPECT_EQ(services_->results.next_unacknowledged()->job_id, job_id_);
  FVD_EXPECT_ERROR_SAYING(kStorageFull, (void)services_->results.acknowledge(job_id_), HasSubstr(job_id_));
  FVD_EXPECT_ERROR_SAYING(kStorageFull, jobs().start({2, "b", "part"}), HasSubstr(job_id_));
  EXPECT_TRUE(jobs().start({1, "a", "part"}).duplicate) << "never a second motion";
}

TEST_F(AnEngineThatCannotStoreAnEnd, StoresItAsSoonAsTheDatabaseWorksAgain) {
  end_a_job();
  broken_->mend();
  ASSERT_TRUE(await([](const MachineStatus& status) { return status.job->not_durable.empty(); }));
  machine().on_change({});
  engine_.reset();
  store_.reset();
  store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");  // as the next start finds it
  EXPECT_EQ(store_->find(job_id_).status.state, JobState::kCompleted);
  EXPECT_NE(store_->find(job_id_).result_json, "");
}

TEST_F(AnEngineThatCannotStoreAnEnd, StoresItBeforeItTakesTheNextJob) {
  end_a_job();
  broken_->mend();
  (void)jobs().start({2, "b", "part"});
  EXPECT_EQ(store_->find(job_id_).status.not_durable, "");
  ASSERT_TRUE(await_end_of(2));
  EXPECT_EQ(machine().snapshot()->job->not_durable, "");
}

TEST_F(AnEngine, RefusesAJobWhoseRowFindsTheDiskFullAndTakesTheNext) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  {
    const test::BrokenDisk broken(ENOSPC);
    EXPECT_THROW(jobs().start({1, "a", "part"}), Error);
  }
  EXPECT_EQ(machine().snapshot()->state, ScanState::kInitialized);
  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate);
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kCompleted);
}

}  // namespace
}  // namespace fvd
