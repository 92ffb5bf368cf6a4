#include "daemon/jobs/machine_board.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.hpp"
#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

MachineBoard::Constants constants() {
  return {.simulated = false, .epoch = 17, .results_waiting = [] { return 3; }};
}

void up(MachineRecord& machine) { machine.set_devices(std::nullopt); }

TEST(MachineBoard, ShowsTheLatestJobAndTheConstantsFromTheStart) {
  JobStatus job;
  job.job_id = "latest";
  const MachineBoard board(constants(), job);
  const auto now = board.snapshot();
  EXPECT_EQ(now->state, ScanState::kPreoperational);
  EXPECT_EQ(now->job->job_id, "latest");
  EXPECT_EQ(now->epoch, 17);
  EXPECT_EQ(now->results_waiting, 3);
}

TEST(MachineBoard, ChangesNothingWhenTheChangeThrows) {
  MachineBoard board(constants(), std::nullopt);
  board.update(up);
  EXPECT_THROW(board.update([](MachineRecord& machine) {
    machine.apply(MachineEvent::kMotionStarted);
    machine.recipe = "other";
    throw Error(ErrorCode::kBusy, "no");
  }),
               Error);
  EXPECT_EQ(board.snapshot()->state, ScanState::kInitialized);
  EXPECT_EQ(board.read().recipe, "");
}

TEST(MachineBoard, ShowsAJobsEndAndItsLostDeviceAsOneChange) {
  MachineBoard board(constants(), std::nullopt);
  board.update(up);
  board.update([](MachineRecord& machine) {
    machine.apply(MachineEvent::kJobOffered);
    machine.apply(MachineEvent::kJobAccepted);
  });
  std::vector<ScanState> seen;
  board.on_change([&] { seen.push_back(board.snapshot()->state); });
  board.update([](MachineRecord& machine) {
    machine.apply(MachineEvent::kJobEnded);
    machine.set_devices(DeviceFailure{ErrorCode::kCameraDisconnected, "gone"});
  });
  EXPECT_EQ(seen, std::vector<ScanState>{ScanState::kError});
  EXPECT_EQ(board.snapshot()->error, ErrorCode::kCameraDisconnected);
}

TEST(MachineBoard, KnowsWhichJobCompletedLastWhateverBegins) {
  JobStatus job;
  job.job_id = "before";
  job.state = JobState::kCompleted;
  MachineBoard board(constants(), job);
  EXPECT_EQ(board.snapshot()->completed_job, "before");
  const auto put = [&board](const std::string& id, JobState state) {
    board.update([&](MachineRecord& machine) {
      machine.job.emplace();
      machine.job->job_id = id;
      machine.job->state = state;
    });
    return board.snapshot()->completed_job;
  };
  EXPECT_EQ(put("a", JobState::kProcessing), "before");
  EXPECT_EQ(put("a", JobState::kCompleted), "a");
  EXPECT_EQ(put("b", JobState::kProcessing), "a");
  EXPECT_EQ(put("b", JobState::kAborted), "a");
  EXPECT_EQ(put("c", JobState::kProcessing), "a");
  EXPECT_EQ(put("c", JobState::kFailed), "a");
  EXPECT_EQ(board.snapshot()->ended.completed, 1U);
  EXPECT_EQ(MachineBoard(constants(), std::nullopt).snapshot()->completed_job, "");
}

TEST(MachineBoard, SaysWhyItRefuses) {
  MachineBoard board(constants(), std::nullopt);
  const auto require = [&](Command command) { board.read().require(command); };
  FVD_EXPECT_ERROR(kNotReady, require(Command::kStartJob));
  board.update([](MachineRecord& machine) {
    machine.set_devices(DeviceFailure{ErrorCode::kStageDisconnected, "no axis"});
  });
  FVD_EXPECT_ERROR_SAYING(kNotReady, require(Command::kRunTask), testing::HasSubstr("no axis"));
  board.update(up);
  require(Command::kStartJob);
  board.update([](MachineRecord& machine) { machine.apply(MachineEvent::kLookStarted); });
  FVD_EXPECT_ERROR(kBusy, require(Command::kRunTask));
  board.update([](MachineRecord& machine) { machine.apply(MachineEvent::kHalt); });
  FVD_EXPECT_ERROR(kShuttingDown, require(Command::kStartJob));
}

TEST(MachineBoard, TellsEachListener) {
  MachineBoard board(constants(), std::nullopt);
  int first = 0;
  int second = 0;
  const int key = 0;
  board.on_change([&] { ++first; });
  board.on_change([&] { ++second; }, &key);
  board.update(up);
  EXPECT_EQ(std::pair(first, second), std::pair(1, 1));
  board.on_change({});
  board.update(up);
  EXPECT_EQ(std::pair(first, second), std::pair(1, 2));
}

TEST(MachineBoard, CallsNoListenerOnceItWasTakenAway) {
  MachineBoard board(constants(), std::nullopt);
  std::jthread changing([&](std::stop_token stop) {
    while (!stop.stop_requested()) board.update([](MachineRecord&) {});
  });
  for (int i = 0; i < 200; ++i) {
    auto alive = std::make_unique<std::atomic<int>>(0);
    board.on_change([&counter = *alive] { ++counter; });
    while (*alive == 0) std::this_thread::yield();
    board.on_change({});
    alive.reset();  // a call from now on is found by the address sanitizer
  }
}

}  // namespace
}  // namespace fvd
