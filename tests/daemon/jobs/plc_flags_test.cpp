/// acquired, part_release and result_valid as a table: how a job ends, and what a line is told of it.

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/daemon/jobs/engine_bench.hpp"

namespace fvd {
namespace {

using test::AnEngine;
using T = sim::TriggerOutcome;

struct Row {
  std::string name;
  std::function<void(test::Bench&)> prepare{};
  bool disk_is_full = false;
  bool is_aborted = false;  ///< while it waits behind a command
  JobState state = JobState::kFailed;
  bool acquired = false;
  bool part_release = false;
  bool result_valid = false;
};

const std::vector<Row> kRows{
    {.name = "Completed", .state = JobState::kCompleted, .acquired = true, .part_release = true, .result_valid = true},
    {.name = "CameraLost",
     .prepare =
         [](test::Bench& bench) {
           bench.script = {T::kFrame, T::kFrame, T::kDisconnect};
         },
     .acquired = true,
     .part_release = true},
    {.name = "StageLost", .prepare = [](test::Bench& bench) { bench.moves_until_lost = 2; }},
    {.name = "StageGoesOnMoving",
     .prepare =
         [](test::Bench& bench) {
           bench.moves_until_restless = 5;  // the last slice's
           bench.stop_works = false;
         },
     .state = JobState::kCompleted,
     .result_valid = true},
    {.name = "DiskFull", .disk_is_full = true, .acquired = true, .part_release = true},
    {.name = "Aborted", .is_aborted = true, .state = JobState::kAborted, .acquired = true, .part_release = true},
};

class TheFlagsOfALine : public AnEngine, public testing::WithParamInterface<Row> {
 protected:
  /// What holds at every moment.
  static void check(const MachineStatus& now) {
    EXPECT_FALSE(now.signals.acquiring && now.signals.part_release);
    if (!now.job) return;
    const bool runs = now.job->state == JobState::kProcessing;
    EXPECT_FALSE(runs && !now.job->acquired && now.signals.part_release) << "the job may still move it";
    EXPECT_FALSE(runs && now.result_valid) << "it is the first job";
    EXPECT_FALSE(now.signals.ready && !now.signals.part_release);
  }
};

TEST_P(TheFlagsOfALine, SayWhatTheyMeanAtEveryMomentOfAJob) {
  const Row& row = GetParam();
  if (row.prepare) row.prepare(bench_);
  open([&row](AtomicDirectory& directory, const ResultData& acquired, FirstFilesWriter* begun) -> JobResult {
    if (!row.disk_is_full) return store_result(directory, acquired, begun);
    (void)begun->finish();
    throw Error(ErrorCode::kStorageFull, "no space is left on the device");
  });
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  if (row.name == "CameraLost") unplug_camera_for_good();
  test::Hold hold;
  if (row.is_aborted) {
    (void)tasks().submit(hold.work(), TaskMotion::kNone);
    hold.began.get_future().wait();
  }
  jobs().start({1, "a", "part"});
  if (row.is_aborted) {
    jobs().abort(ClientSeq{1});
    hold.go.set_value();
  }
  ASSERT_TRUE(await([](const MachineStatus& now) {
    check(now);
    return now.job && now.job->state != JobState::kProcessing;
  }));
  const auto now = machine().snapshot();
  EXPECT_EQ(now->job->state, row.state);
  EXPECT_EQ(now->job->acquired, row.acquired);
  EXPECT_EQ(now->signals.part_release, row.part_release);
  EXPECT_EQ(now->result_valid, row.result_valid);
  EXPECT_EQ(now->results_waiting, 1) << "the end of every job is told until it is acknowledged";
  EXPECT_EQ(store_->find(ClientSeq{1}).status.acquired, row.acquired) << "and after a restart";
  EXPECT_EQ(services_->results.acknowledge(ClientSeq{1}), 0);
  EXPECT_FALSE(machine().snapshot()->result_valid);
  bench_.stop_works = true;
}

INSTANTIATE_TEST_SUITE_P(For, TheFlagsOfALine, testing::ValuesIn(kRows),
                         [](const testing::TestParamInfo<Row>& row) { return row.param.name; });

}  // namespace
}  // namespace fvd
