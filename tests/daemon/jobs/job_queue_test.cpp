#include "daemon/jobs/job_queue.hpp"

#include <future>
#include <thread>

#include <sqlite3.h>
#include <unistd.h>

#include "gtest/gtest.h"
#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A disk on which SQLite's first write waits until it is let go. One at a time.
class HeldDisk {
 public:
  HeldDisk() {
    writing_ = std::make_unique<std::promise<void>>();
    go_ = std::make_unique<std::promise<void>>();
    held_ = false;
    set(reinterpret_cast<sqlite3_syscall_ptr>(&held_pwrite));
  }
  ~HeldDisk() { set(nullptr); }
  HeldDisk(const HeldDisk&) = delete;
  HeldDisk& operator=(const HeldDisk&) = delete;

  [[nodiscard]] bool await_write() { return writing_->get_future().wait_for(seconds(10)) == std::future_status::ready; }
  void let_go() { go_->set_value(); }

 private:
  static void set(sqlite3_syscall_ptr function) {
    sqlite3_vfs* vfs = sqlite3_vfs_find(nullptr);
    for (const char* call : {"pwrite", "pwrite64"}) vfs->xSetSystemCall(vfs, call, function);
  }
  static ssize_t held_pwrite(int file, const void* bytes, std::size_t count, off_t offset) {
    if (!held_.exchange(true)) {
      writing_->set_value();
      go_->get_future().wait_for(seconds(10));
    }
    return ::pwrite(file, bytes, count, offset);
  }
  static inline std::unique_ptr<std::promise<void>> writing_;
  static inline std::unique_ptr<std::promise<void>> go_;
  static inline std::atomic<bool> held_ = false;
};

class AJobQueue : public test::AnEngine {
 protected:
  [[nodiscard]] std::future<JobService::Started> start_aside(const JobRequest& request) {
    return std::async(std::launch::async, [this, request] { return jobs().start(request); });
  }
};

TEST_F(AJobQueue, ShowsAJobOnlyOnceItIsDurableAndKeepsNobodyWaitingMeanwhile) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  HeldDisk disk;
  auto started = start_aside({1, "a", "part"});
  ASSERT_TRUE(disk.await_write());

  EXPECT_FALSE(machine().snapshot()->job.has_value());
  EXPECT_EQ(machine().snapshot()->state, ScanState::kInitialized);
  // Another client's command is taken, done and answered while the job's row is written.
  const auto task =
      tasks().submit([](const Devices&, std::stop_token) { return std::string("{}"); }, TaskMotion::kMoves);
  ASSERT_TRUE(await_answer(*task));
  EXPECT_EQ(task->outcome()->json, "{}");
  EXPECT_NE(started.wait_for(milliseconds(0)), std::future_status::ready);

  disk.let_go();
  EXPECT_FALSE(started.get().duplicate);
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AJobQueue, GivesTheSameJobToARepetitionThatComesWhileTheFirstIsMadeDurable) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  HeldDisk disk;
  auto first = start_aside({1, "a", "part"});
  ASSERT_TRUE(disk.await_write());
  std::vector<std::future<JobService::Started>> repetitions;
  for (int i = 0; i < 4; ++i) repetitions.push_back(start_aside({1, "a", "part"}));
  disk.let_go();
  const JobService::Started started = first.get();
  EXPECT_FALSE(started.duplicate);
  for (auto& repetition : repetitions) {
    const JobService::Started again = repetition.get();
    EXPECT_TRUE(again.duplicate);
    EXPECT_EQ(again.job.job_id, started.job.job_id);
  }
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AJobQueue, RefusesAnotherPartUnderTheSameNumberWhileTheFirstIsMadeDurable) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  HeldDisk disk;
  auto first = start_aside({1, "a", "part"});
  ASSERT_TRUE(disk.await_write());
  auto other = start_aside({1, "b", "part"});
  disk.let_go();
  (void)first.get();
  FVD_EXPECT_ERROR(kSeqConflict, (void)other.get());
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AJobQueue, AcceptsOneOfManyJobsThatComeAtOnce) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  test::Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);  // the job that wins waits behind it
  hold.began.get_future().wait();
  std::vector<std::future<JobService::Started>> starts;
  for (int i = 1; i <= 8; ++i) starts.push_back(start_aside({i, "a", "part"}));
  int accepted = 0;
  int busy = 0;
  for (auto& start : starts) {
    try {
      EXPECT_FALSE(start.get().duplicate);
      ++accepted;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBusy) << error.what();
      ++busy;
    }
  }
  EXPECT_EQ(accepted, 1);
  EXPECT_EQ(busy, 7);
  hold.go.set_value();
  ASSERT_TRUE(await([](const MachineStatus& now) { return now.job && now.job->state != JobState::kProcessing; }));
}

TEST_F(AJobQueue, TakesTheNextJobAfterARecipeThatIsRefused) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  FVD_EXPECT_ERROR(kUnknownRecipe, jobs().start({1, "a", "nothing"}));
  FVD_EXPECT_ERROR(kUnknownRecipe, jobs().start({1, "a", ""}));
  test::write_text(folder_.path() / "far.json", R"({"scan": {"start_um": 0, "step_um": 1000, "slices": 5}})");
  FVD_EXPECT_ERROR(kStageLimit, jobs().start({1, "a", "far"}));
  EXPECT_EQ(machine().snapshot()->state, ScanState::kInitialized);
  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate);
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->recipe, "part");
}

TEST_F(AJobQueue, RefusesARecipeThatLooksOutsideOfTheFieldOfViewBeforeAnythingMoves) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  test::write_text(folder_.path() / "off.json", R"({"format": 2,
    "acquire": {"scan": {"start_um": 0, "step_um": 10, "slices": 5}},
    "reconstruct": {"lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.5}},
    "evaluation": {"regions": {"r": {"rectangle_um": {"x": 9000, "y": 0, "width": 5, "height": 5}}},
                   "measurements": {"a": {"kind": "areal", "region": "r", "parameters": ["Sa"]},
                                    "b": {"kind": "profile", "id": "b", "from_um": [0, 0], "to_um": [0, 9000],
                                          "parameters": ["Ra"]}}}})");

  std::string message;
  try {
    jobs().prepare("off");
  } catch (const Error& error) {
    message = error.what();
    EXPECT_EQ(error.code(), ErrorCode::kRegionOutside);
  }

  EXPECT_NE(message.find("recipe off: /evaluation/regions/r/rectangle_um: "), std::string::npos) << message;
  EXPECT_NE(message.find("recipe off: /evaluation/measurements/b/to_um: "), std::string::npos) << message;
  FVD_EXPECT_ERROR(kRegionOutside, jobs().start({1, "a", "off"}));
  EXPECT_FALSE(jobs().start({1, "a", "part"}).duplicate);
  ASSERT_TRUE(await_end_of(1));
}

TEST_F(AJobQueue, EndsAJobThatBecomesDurableWhenTheDaemonIsAlreadyEnding) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  HeldDisk disk;
  auto started = start_aside({1, "a", "part"});
  ASSERT_TRUE(disk.await_write());
  engine_->finish();
  disk.let_go();
  const std::string id = started.get().job.job_id;
  EXPECT_EQ(store_->find(id).status.state, JobState::kFailed);
  EXPECT_EQ(store_->find(id).status.error, ErrorCode::kShuttingDown);
}

TEST_F(AJobQueue, AcknowledgesAnEndedJobAndRefusesARunningOne) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  test::Hold hold;
  const auto task = tasks().submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  jobs().start({1, "a", "part"});
  FVD_EXPECT_ERROR(kBusy, services_->results.acknowledge(ClientSeq{1}));
  hold.go.set_value();
  ASSERT_TRUE(await_end_of(1));
  EXPECT_EQ(machine().snapshot()->results_waiting, 1);
  EXPECT_EQ(services_->results.acknowledge(ClientSeq{1}), 0);
  EXPECT_TRUE(machine().snapshot()->job->acknowledged);
  EXPECT_EQ(machine().snapshot()->results_waiting, 0);
}

}  // namespace
}  // namespace fvd
