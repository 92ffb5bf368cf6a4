/// stop_motion(): a command, a job, a job that is being accepted.

#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd::test {
namespace {

using Stopped = JobService::Stopped;

/// Work that goes on until it is stopped.
struct Motion {
  std::promise<void> began;
  DeviceTask::Work work() {
    return [this](const Devices&, const std::stop_token& stop) -> std::string {
      began.set_value();
      Mutex mutex;
      Condition never;
      MutexLock lock(mutex);
      (void)never.wait_for(lock, stop, std::chrono::seconds(20), [] { return false; });
      if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "stopped");
      return "{}";
    };
  }
};

TEST_F(AnEngine, StopsACommandThatMoves) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  EXPECT_EQ(jobs().stop_motion(), Stopped::kNothing);
  Motion motion;
  const auto task = tasks().submit(motion.work(), TaskMotion::kMoves);
  motion.began.get_future().wait();
  const HostTime before = HostClock::now();
  EXPECT_EQ(jobs().stop_motion(), Stopped::kCommand);
  EXPECT_TRUE(jobs().stopped_since(before));
  EXPECT_FALSE(jobs().stopped_since(HostClock::now()));
  ASSERT_TRUE(await_answer(*task));
  EXPECT_EQ(task->outcome()->error, ErrorCode::kAborted);
  EXPECT_TRUE(await_state(ScanState::kInitialized));
}

TEST_F(AnEngine, AbortsAJobThatHoldsThePart) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto look = tasks().submit(hold.work(), TaskMotion::kNone);  // the job waits behind it
  hold.began.get_future().wait();
  const JobStatus job = jobs().start({1, "p", "part"}).job;
  EXPECT_EQ(jobs().stop_motion(), Stopped::kJob);
  hold.go.set_value();
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(jobs().job(job.job_id).state, JobState::kAborted);
  EXPECT_FALSE(jobs().try_abort(JobKey{std::string("no such job")})) << "files are not looked into";
  EXPECT_EQ(jobs().try_abort(JobKey{job.job_id})->state, JobState::kAborted) << "no effect on one that has ended";
}

TEST_F(AnEngine, BeginsNothingThatWasAskedForBeforeAStop) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  const HostTime before = HostClock::now();
  jobs().stop_motion();
  JobRequest job{1, "p", "part"};
  job.asked = before;
  FVD_EXPECT_ERROR(kAborted, jobs().start(job));
  FVD_EXPECT_ERROR(kAborted, tasks().submit([](const Devices&, std::stop_token) { return std::string("{}"); },
                                            TaskMotion::kMoves, before));
  FVD_EXPECT_ERROR(kAborted, tasks().jog({true, 1e9, HostClock::now() + std::chrono::seconds(5), "test", before}));
  EXPECT_FALSE(jobs().highest("plc")) << "its number is not used up";
  job.asked = HostClock::now();
  EXPECT_FALSE(jobs().start(job).duplicate);
  EXPECT_TRUE(await_end_of(1));
}

TEST_F(AnEngine, JogsAndTellsTheNextRepeatWhyItEnded) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  const JogRequest jog{true, 1e9, HostClock::now() + std::chrono::seconds(5), "test"};
  EXPECT_FALSE(tasks().extend_jog(jog));
  JogRequest late = jog;
  late.until = HostClock::now();
  FVD_EXPECT_ERROR(kTimeout, tasks().jog(late));
  tasks().jog(jog);
  ASSERT_TRUE(await_state(ScanState::kInitialized)) << "the fake is at its limit at once";
  tasks().jog(jog);
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  FVD_EXPECT_ERROR(kStageLimit, tasks().jog(jog));
}

}  // namespace
}  // namespace fvd::test
