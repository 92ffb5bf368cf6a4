#include "daemon/jobs/engine.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "daemon/api/json_shapes.hpp"
#include "daemon/jobs/device_commands.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using std::chrono::seconds;

/// What outlives the devices: they are closed on another thread.
struct Bench {
  std::mutex mutex;
  std::condition_variable changed;
  bool interrupting = false;
  bool camera_gone = false;
  bool gone_while_interrupted = false;
  bool watch_interrupt = false;
  bool plugged = true;  ///< a camera can be opened
  std::atomic<bool> axis_moves{false};
  std::atomic<bool> stop_works{true};
  std::atomic<int> stops{0};
  std::deque<sim::TriggerOutcome> script;
};

class BenchCamera final : public sim::FakeCamera {
 public:
  BenchCamera(sim::FakeClock& clock, Bench& bench)
      : FakeCamera(clock, 16, 16, std::exchange(bench.script, {})), bench_(bench) {}
  ~BenchCamera() override {
    const std::lock_guard lock(bench_.mutex);
    bench_.camera_gone = true;
    bench_.changed.notify_all();
  }
  /// While watched it takes its time, as one that talks to a device does: long enough for a wrong owner to close it.
  void interrupt() noexcept override {
    Bench& bench = bench_;
    std::unique_lock lock(bench.mutex);
    if (!bench.watch_interrupt) return FakeCamera::interrupt();
    bench.interrupting = true;
    bench.changed.notify_all();
    bench.gone_while_interrupted =
        bench.changed.wait_for(lock, std::chrono::milliseconds(200), [&] { return bench.camera_gone; });
  }

 private:
  Bench& bench_;
};

class BenchAxis final : public sim::FakeAxis {
 public:
  BenchAxis(sim::FakeClock& clock, Bench& bench) : FakeAxis(clock), bench_(bench) {}
  StageStatus status() override {
    StageStatus status = FakeAxis::status();
    status.moving = bench_.axis_moves;
    return status;
  }
  void stop() noexcept override {
    ++bench_.stops;
    if (bench_.stop_works) bench_.axis_moves = false;
  }

 private:
  Bench& bench_;
};

class AnEngine : public testing::Test {
 protected:
  AnEngine() {
    config_.paths.state_dir = folder_.path();
    config_.paths.recipe_dir = folder_.path();
    config_.compute.threads = 1;
    std::filesystem::create_directories(folder_.path() / "results");
    test::write_text(folder_.path() / "part.json", R"({"scan": {"start_um": 0, "step_um": 10, "slices": 21}})");
    store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");
  }

  void open() {
    engine_ = std::make_unique<Engine>(
        config_, EngineDependencies{*store_, clock_,
                                    [this]() -> std::unique_ptr<Camera> {
                                      const std::lock_guard lock(bench_.mutex);
                                      if (!bench_.plugged) {
                                        throw Error(ErrorCode::kCameraDisconnected, "no camera is plugged in");
                                      }
                                      return std::make_unique<BenchCamera>(clock_, bench_);
                                    },
                                    [this] { return std::make_unique<BenchAxis>(clock_, bench_); }});
    engine_->on_change([this] {
      const auto now = engine_->snapshot();
      const std::lock_guard lock(seen_mutex_);
      if (seen_.empty() || seen_.back() != now->state) seen_.push_back(now->state);
      seen_changed_.notify_all();
    });
  }
  void TearDown() override {
    if (engine_) {
      engine_->finish();
      engine_->on_change({});
    }
  }
  template <typename Predicate>
  [[nodiscard]] bool await(Predicate predicate) {
    std::unique_lock lock(seen_mutex_);
    const auto deadline = std::chrono::steady_clock::now() + seconds(10);
    while (!predicate(*engine_->snapshot())) {
      // A change between the look and the wait is told under seen_mutex_; the first states may come before the
      // listener.
      if (std::chrono::steady_clock::now() > deadline) return false;
      seen_changed_.wait_for(lock, std::chrono::milliseconds(20));
    }
    return true;
  }
  [[nodiscard]] bool await_state(ScanState state) {
    return await([state](const MachineStatus& now) { return now.state == state; });
  }
  [[nodiscard]] bool job_ended() {
    return await([](const MachineStatus& now) { return now.job && now.job->state != JobState::kProcessing; });
  }
  [[nodiscard]] nlohmann::ordered_json signals() const { return machine_status_json(*engine_->snapshot(), 1); }

  /// Work that says that it began and goes on until it is let go.
  struct Hold {
    std::promise<void> began;
    std::promise<void> go;
    DeviceTask::Work work() {
      return [this](const Devices&, std::stop_token) {
        began.set_value();
        go.get_future().wait_for(seconds(10));
        return std::string("{}");
      };
    }
  };

  test::ScratchDir folder_;
  Config config_;
  sim::FakeClock clock_;
  Bench bench_;
  std::mutex seen_mutex_;
  std::condition_variable seen_changed_;
  std::vector<ScanState> seen_;
  std::unique_ptr<JobStore> store_;
  std::unique_ptr<Engine> engine_;
};

TEST_F(AnEngine, NeverClosesACameraThatIsBeingInterrupted) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  {
    const std::lock_guard lock(bench_.mutex);
    bench_.watch_interrupt = true;
  }
  Hold hold;
  const auto task = engine_->submit(
      [this, &hold](const Devices&, std::stop_token) -> std::string {
        hold.began.set_value();
        std::unique_lock lock(bench_.mutex);
        bench_.changed.wait_for(lock, seconds(10), [this] { return bench_.interrupting; });
        throw Error(ErrorCode::kCameraDisconnected, "pulled");
      },
      TaskMotion::kNone);
  hold.began.get_future().wait();
  engine_->start({1, "a", "part"});
  ASSERT_TRUE(job_ended());
  const std::lock_guard lock(bench_.mutex);
  EXPECT_TRUE(bench_.interrupting);
  EXPECT_FALSE(bench_.gone_while_interrupted);
  bench_.watch_interrupt = false;
}

TEST_F(AnEngine, IsExecutingAndHoldsThePartWhileACommandRuns) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  EXPECT_EQ(signals()["part_release"], true);
  Hold hold;
  const auto task = engine_->submit(hold.work(), TaskMotion::kMoves);
  hold.began.get_future().wait();
  const auto during = signals();
  EXPECT_EQ(during["state"], "executing");
  EXPECT_EQ(during["ready"], false);
  EXPECT_EQ(during["busy"], true);
  EXPECT_EQ(during["part_release"], false);
  engine_->prepare("part");
  hold.go.set_value();
  ASSERT_TRUE(await_state(ScanState::kReady)) << "the recipe that was prepared meanwhile counts";
  EXPECT_EQ(signals()["part_release"], true);
}

TEST_F(AnEngine, StaysReadyForAPartWhileACommandTakesAnImage) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto task = engine_->submit(hold.work(), TaskMotion::kNone);
  hold.began.get_future().wait();
  EXPECT_EQ(signals()["ready"], true);
  EXPECT_EQ(signals()["part_release"], true);
  EXPECT_THROW(engine_->submit(hold.work(), TaskMotion::kMoves), Error) << "one command at a time";
  hold.go.set_value();
  ASSERT_TRUE(await([&](const MachineStatus&) { return task->outcome().has_value(); }));
}

TEST_F(AnEngine, LeadsACommandWithoutARecipeBackToInitializedAndTakesAJobMeanwhile) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  engine_->submit([](const Devices&, std::stop_token) { return std::string("{}"); }, TaskMotion::kMoves);
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto task = engine_->submit(hold.work(), TaskMotion::kMoves);
  hold.began.get_future().wait();
  EXPECT_FALSE(engine_->start({1, "a", "part"}).duplicate);
  EXPECT_EQ(signals()["part_release"], false);
  hold.go.set_value();
  ASSERT_TRUE(job_ended());
}

TEST_F(AnEngine, StopsAnAxisThatMovesWhenItIsOpenedAndIsNotReadyBeforeItStands) {
  bench_.axis_moves = true;
  bench_.stop_works = false;
  open();
  ASSERT_TRUE(await([this](const MachineStatus&) { return bench_.stops >= 2; }));
  EXPECT_EQ(signals()["part_release"], false);
  EXPECT_EQ(signals()["ready"], false);
  EXPECT_THROW(engine_->start({1, "a", "part"}), Error);
  bench_.stop_works = true;
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  EXPECT_FALSE(bench_.axis_moves);
  EXPECT_EQ(signals()["part_release"], true);
}

TEST_F(AnEngine, GoesToErrorDirectlyWhenAJobLosesItsCamera) {
  bench_.script = {sim::TriggerOutcome::kFrame, sim::TriggerOutcome::kDisconnect};
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  {
    const std::lock_guard lock(bench_.mutex);
    bench_.plugged = false;
  }
  engine_->start({1, "a", "part"});
  ASSERT_TRUE(job_ended());
  EXPECT_EQ(engine_->snapshot()->job->error, ErrorCode::kCameraDisconnected);
  ASSERT_TRUE(await_state(ScanState::kError));
  const std::lock_guard lock(seen_mutex_);
  const auto executing = std::find(seen_.begin(), seen_.end(), ScanState::kExecuting);
  ASSERT_NE(executing, seen_.end());
  ASSERT_NE(executing + 1, seen_.end());
  EXPECT_EQ(*(executing + 1), ScanState::kError);
}

TEST_F(AnEngine, EndsAJobThatWasPendingAtShutdown) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  Hold hold;
  const auto task = engine_->submit(hold.work(), TaskMotion::kMoves);
  hold.began.get_future().wait();
  engine_->start({1, "a", "part"});
  engine_->shut_down();
  hold.go.set_value();
  engine_->finish();
  const JobStatus ended = store_->find(ClientSeq{1}).status;
  EXPECT_EQ(ended.state, JobState::kFailed);
  EXPECT_EQ(ended.error, ErrorCode::kShuttingDown);
}

}  // namespace
}  // namespace fvd
