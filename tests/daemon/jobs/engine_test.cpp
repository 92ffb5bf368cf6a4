#include "daemon/jobs/engine.hpp"

#include <memory>
#include <string>

#include <gmock/gmock.h>

#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/support/captured_log.hpp"

namespace fvd {
namespace {

using std::chrono::seconds;
using test::AnEngine;
using test::CapturedLog;
using test::Hold;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(AnEngine, NeverClosesACameraThatIsBeingInterrupted) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  {
    const std::lock_guard lock(bench_.mutex);
    bench_.watch_interrupt = true;
  }
  Hold hold;
  const auto task = tasks().submit(
      [this, &hold](const Devices&, std::stop_token) -> std::string {
        hold.began.set_value();
        std::unique_lock lock(bench_.mutex);
        bench_.changed.wait_for(lock, seconds(10), [this] { return bench_.interrupting; });
        throw Error(ErrorCode::kCameraDisconnected, "pulled");
      },
      TaskMotion::kNone);
  hold.began.get_future().wait();
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_end_of(1));
  const std::lock_guard lock(bench_.mutex);
  EXPECT_TRUE(bench_.interrupting);
  EXPECT_FALSE(bench_.gone_while_interrupted);
  bench_.watch_interrupt = false;
}

TEST_F(AnEngine, SeesTheStageMoveWhileACommandKeepsTheMachinesThread) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  EXPECT_TRUE(machine().stage_stands());
  bench_.seen_moving = true;
  EXPECT_TRUE(signals().part_release) << "nobody has looked yet";
  EXPECT_FALSE(machine().stage_stands());
  bench_.seen_moving = false;
  hold.go.set_value();
  ASSERT_TRUE(await_answer(*task));
}

TEST_F(AnEngine, IsExecutingAndHoldsThePartWhileACommandRuns) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  EXPECT_TRUE(signals().part_release);
  Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kMoves);
  hold.began.get_future().wait();
  EXPECT_EQ(machine().snapshot()->state, ScanState::kExecuting);
  EXPECT_EQ(signals(), (Signals{.busy = true}));
  jobs().prepare("part");
  hold.go.set_value();
  ASSERT_TRUE(await_state(ScanState::kReady)) << "the recipe that was prepared meanwhile counts";
  EXPECT_TRUE(signals().part_release);
}

TEST_F(AnEngine, HoldsThePartOfACommandWhoseStageDoesNotComeToRest) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  bench_.stop_works = false;
  const auto task = tasks().submit(
      [this](const Devices&, std::stop_token) {
        bench_.axis_moves = true;  // as a drive that says too early that it has arrived
        return std::string("{}");
      },
      TaskMotion::kMoves);
  ASSERT_TRUE(await_answer(*task));
  EXPECT_FALSE(signals().part_release);
  EXPECT_FALSE(signals().ready);
  bench_.stop_works = true;
  ASSERT_TRUE(await([](const MachineStatus& status) { return status.signals.part_release; }));
}

TEST_F(AnEngine, StaysReadyForAPartWhileACommandTakesAnImage) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  EXPECT_TRUE(signals().ready);
  EXPECT_TRUE(signals().part_release);
  EXPECT_THROW(tasks().submit(hold.work(), TaskMotion::kMoves), Error) << "one command at a time";
  hold.go.set_value();
  ASSERT_TRUE(await_answer(*task));
}

TEST_F(AnEngine, LeadsACommandWithoutARecipeBackToInitializedAndTakesAJobMeanwhile) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  const auto first =
      tasks().submit([](const Devices&, std::stop_token) { return std::string("{}"); }, TaskMotion::kMoves);
  ASSERT_TRUE(await_answer(*first));
  EXPECT_EQ(machine().snapshot()->state, ScanState::kInitialized) << "the state comes before the answer";
  Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kMoves);
  hold.began.get_future().wait();
  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate);
  EXPECT_FALSE(signals().part_release);
  hold.go.set_value();
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AnEngine, AnswersACommandThatFailsWhileAJobIsStartedAndRunsTheJob) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  std::promise<void> began;
  const auto task = tasks().submit(
      [&began](const Devices&, std::stop_token stop) -> std::string {
        began.set_value();
        const auto deadline = std::chrono::steady_clock::now() + seconds(10);
        while (!stop.stop_requested() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
        throw Error(ErrorCode::kStagePosition, "does not settle");
      },
      TaskMotion::kMoves);
  began.get_future().wait();
  jobs().start({1, "a", "part"});
  ASSERT_TRUE(await_answer(*task));
  EXPECT_EQ(task->outcome()->error, ErrorCode::kStagePosition);
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kCompleted);
  EXPECT_EQ(machine().snapshot()->state, ScanState::kReady);
}

TEST_F(AnEngine, StopsAnAxisThatMovesWhenItIsOpenedAndIsNotReadyBeforeItStands) {
  bench_.axis_moves = true;
  bench_.stop_works = false;
  open();
  ASSERT_TRUE(await([this](const MachineStatus&) { return bench_.stops >= 2; }));
  EXPECT_FALSE(signals().part_release);
  EXPECT_FALSE(signals().ready);
  EXPECT_THROW(jobs().start({1, "a", "part"}), Error);
  bench_.stop_works = true;
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  EXPECT_FALSE(bench_.axis_moves);
  EXPECT_TRUE(signals().part_release);
}

TEST_F(AnEngine, AbortsAJobThatWaitsBehindACommand) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  jobs().start({1, "a", "part"});
  jobs().abort(ClientSeq{1});
  hold.go.set_value();
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->job->state, JobState::kAborted);
  EXPECT_EQ(machine().snapshot()->job->error, ErrorCode::kAborted);
}

TEST_F(AnEngine, SaysAtEveryStartWhichJobARestartInterruptedUntilThatIsAcknowledged) {
  const std::string job_id = store_->accept({7, "P-1", "part"}).job_id;
  store_.reset();  // the process ends while the job runs
  store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");
  const auto logged_by_a_start = [this] {
    const CapturedLog log;
    open();
    machine().on_change({});
    engine_.reset();
    return log.text();
  };

  for (int start = 0; start < 2; ++start) {
    EXPECT_THAT(logged_by_a_start(), AllOf(HasSubstr("[warning] job " + job_id + " of client plc, seq 7, part 'P-1'"),
                                           HasSubstr("measure the part again with a new sequence number")));
  }
  (void)store_->acknowledge(job_id);
  EXPECT_THAT(logged_by_a_start(), Not(HasSubstr(job_id)));
}

TEST_F(AnEngine, EndsAJobThatWasPendingAtShutdown) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kMoves);
  hold.began.get_future().wait();
  jobs().start({1, "a", "part"});
  engine_->shut_down();
  hold.go.set_value();
  engine_->finish();
  const JobStatus ended = store_->find(ClientSeq{1}).status;
  EXPECT_EQ(ended.state, JobState::kFailed);
  EXPECT_EQ(ended.error, ErrorCode::kShuttingDown);
  EXPECT_EQ(machine().snapshot()->job->error, ErrorCode::kShuttingDown) << "who waits for it is told";
}

TEST_F(AnEngine, AnswersACommandThatWasPendingAtShutdown) {
  // The device thread is still opening the camera anew when the command is taken and the daemon is told to end.
  bench_.script = {sim::TriggerOutcome::kNothing, sim::TriggerOutcome::kNothing, sim::TriggerOutcome::kNothing,
                   sim::TriggerOutcome::kNothing};
  std::promise<void> opening;
  std::promise<void> go;
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  hold_camera_opening(opening, go);
  jobs().start({1, "a", "part"});
  opening.get_future().wait();
  ASSERT_TRUE(await_end_of(1));
  const auto task =
      tasks().submit([](const Devices&, std::stop_token) { return std::string("{}"); }, TaskMotion::kMoves);
  engine_->shut_down();
  go.set_value();
  engine_->finish();
  ASSERT_TRUE(task->outcome().has_value());
  EXPECT_EQ(task->outcome()->error, ErrorCode::kShuttingDown);
  EXPECT_THROW(tasks().submit([](const Devices&, std::stop_token) { return std::string(); }, TaskMotion::kNone), Error);
}

TEST_F(AnEngine, AbortsTheJobThatRunsAtShutdown) {
  std::promise<void> storing;
  open([&](AtomicDirectory&, const ResultData&, FirstFilesWriter*) -> JobResult {
    storing.set_value();
    const auto deadline = std::chrono::steady_clock::now() + seconds(10);
    while (machine().snapshot()->state != ScanState::kHalted && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    throw Error(ErrorCode::kAborted, "stopped");
  });
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  jobs().start({1, "a", "part"});
  storing.get_future().wait();
  engine_->finish();
  const JobStatus ended = store_->find(ClientSeq{1}).status;
  EXPECT_EQ(ended.state, JobState::kAborted);
  EXPECT_EQ(ended.error, ErrorCode::kShuttingDown);
}

TEST_F(AnEngine, TellsTheEndOfAJobBeforeItOpensTheCameraAnew) {
  bench_.script = {4, sim::TriggerOutcome::kNothing};
  std::promise<void> opening;
  std::promise<void> go;
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  hold_camera_opening(opening, go);
  jobs().start({1, "a", "part"});
  opening.get_future().wait();
  const auto now = machine().snapshot();
  EXPECT_EQ(now->job->state, JobState::kFailed);
  EXPECT_EQ(now->job->error, ErrorCode::kCameraNoFrames);
  EXPECT_EQ(store_->find(ClientSeq{1}).status.state, JobState::kFailed);
  go.set_value();
  ASSERT_TRUE(await([this](const MachineStatus&) {
    const std::lock_guard lock(bench_.mutex);
    return bench_.camera_openings == 2;
  }));
}

}  // namespace
}  // namespace fvd
