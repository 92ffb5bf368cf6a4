#pragma once

/// An engine on in-process devices that a test breaks, holds and watches.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "daemon/jobs/engine.hpp"
#include "sim/fakes/fakes.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

/// What outlives the devices: they are closed on another thread.
struct Bench {
  std::mutex mutex;
  std::condition_variable changed;
  bool interrupting = false;
  bool camera_gone = false;
  bool gone_while_interrupted = false;
  bool watch_interrupt = false;
  bool camera_plugged = true;  ///< a camera can be opened
  bool axis_plugged = true;
  int camera_openings = 0;
  std::function<void()> on_camera_opening;
  std::atomic<bool> axis_moves{false};
  std::atomic<bool> stop_works{true};
  std::atomic<int> stops{0};
  std::atomic<int> moves{0};
  std::atomic<int> moves_until_restless{-1};  ///< the axis goes on moving after the move that counts this to 0
  std::atomic<bool> lost_at_rest{false};      ///< the axis is lost when it is looked at after that many moves:
  std::atomic<int> moves_until_rest{-1};
  std::atomic<bool> seen_moving{false};   ///< by whoever samples the axis
  std::atomic<int> moves_until_lost{-1};  ///< the axis is lost at the move that counts this to 0; < 0 = never
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
    if (!bench.watch_interrupt) return;  // the fake never waits
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
    if (bench_.lost_at_rest && moved_) unplug();
    require_line();
    StageStatus status = FakeAxis::status();
    status.moving = bench_.axis_moves;
    return status;
  }
  MoveRecord move_to(Micrometers target, const SettleCriterion& criterion, std::stop_token stop) override {
    if (bench_.moves_until_lost >= 0 && bench_.moves_until_lost-- == 0) {
      unplug();
    }
    require_line();
    ++bench_.moves;
    MoveRecord move = FakeAxis::move_to(target, criterion, std::move(stop));
    moved_ = bench_.moves_until_rest >= 0 && bench_.moves_until_rest-- == 0;
    if (bench_.moves_until_restless >= 0 && bench_.moves_until_restless-- == 0) bench_.axis_moves = true;
    return move;
  }
  [[nodiscard]] std::optional<StageStatus> last_seen() const override {
    if (!bench_.seen_moving) return std::nullopt;
    StageStatus status;
    status.state = AxisState::kMoving;
    status.sampled = HostClock::now();
    return status;
  }
  void stop() noexcept override {
    ++bench_.stops;
    if (bench_.stop_works) bench_.axis_moves = false;
  }
  [[nodiscard]] bool connected() const noexcept override { return connected_; }

 private:
  void unplug() {
    connected_ = false;
    const std::lock_guard lock(bench_.mutex);
    bench_.axis_plugged = false;
  }
  void require_line() const {
    if (!connected_) throw Error(ErrorCode::kStageDisconnected, "the fake axis was unplugged");
  }
  Bench& bench_;
  std::atomic<bool> connected_{true};
  std::atomic<bool> moved_{false};
};

/// Work that says that it began and goes on until it is let go.
struct Hold {
  std::promise<void> began;
  std::promise<void> go;
  DeviceTask::Work work() {
    return [this](const Devices&, std::stop_token) {
      began.set_value();
      go.get_future().wait_for(std::chrono::seconds(10));
      return std::string("{}");
    };
  }
};

class AnEngine : public testing::Test {
 protected:
  AnEngine() {
    config_.paths.state_dir = folder_.path();
    config_.paths.recipe_dir = folder_.path();
    config_.compute.threads = 1;
    config_.compute.queue_slices = 64;  // time passes at once here: nobody waits for room in the queue
    std::filesystem::create_directories(folder_.path() / "results");
    write_text(folder_.path() / "part.json", R"({"scan": {"start_um": 0, "step_um": 10, "slices": 5}})");
    store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");
  }

  /// The next opening of the camera says that it began and goes on until it is let go.
  void hold_camera_opening(std::promise<void>& opening, std::promise<void>& go) {
    const std::lock_guard lock(bench_.mutex);
    bench_.on_camera_opening = [&] {
      opening.set_value();
      go.get_future().wait_for(std::chrono::seconds(10));
    };
  }

  void open(ResultPipeline make_result = store_result) {
    const auto open_camera = [this]() -> std::unique_ptr<Camera> {
      const std::lock_guard lock(bench_.mutex);
      if (bench_.on_camera_opening) bench_.on_camera_opening();
      if (!bench_.camera_plugged) throw Error(ErrorCode::kCameraDisconnected, "no camera is plugged in");
      ++bench_.camera_openings;
      return std::make_unique<BenchCamera>(clock_, bench_);
    };
    const auto open_axis = [this]() -> std::unique_ptr<Axis> {
      const std::lock_guard lock(bench_.mutex);
      if (!bench_.axis_plugged) throw Error(ErrorCode::kStageDisconnected, "no stage is plugged in");
      return std::make_unique<BenchAxis>(clock_, bench_);
    };
    engine_ = std::make_unique<Engine>(
        config_, EngineDependencies{*store_, clock_, {open_camera, open_axis}, std::move(make_result)});
    engine_->start();
    services_.emplace(engine_->services());
    machine().on_change([this] {
      const auto now = machine().snapshot();
      const std::lock_guard lock(seen_mutex_);
      if (seen_.empty() || seen_.back() != now->state) seen_.push_back(now->state);
      seen_changed_.notify_all();
    });
  }
  void TearDown() override {
    if (!engine_) return;
    engine_->finish();
    machine().on_change({});
  }

  template <typename Predicate>
  [[nodiscard]] bool await(Predicate predicate) {
    std::unique_lock lock(seen_mutex_);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!predicate(*machine().snapshot())) {
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
  [[nodiscard]] bool await_end_of(std::int64_t seq) {
    return await([seq](const MachineStatus& now) {
      return now.job && now.job->request.seq == seq && now.job->state != JobState::kProcessing;
    });
  }
  [[nodiscard]] bool await_answer(const DeviceTask& task) {
    return await([&task](const MachineStatus&) { return task.outcome().has_value(); });
  }
  /// The state that came after the first kExecuting; nothing if none does. A snapshot may show it before it is told.
  [[nodiscard]] std::optional<ScanState> state_behind_executing() {
    std::unique_lock lock(seen_mutex_);
    const auto behind = [this]() -> std::optional<ScanState> {
      const auto executing = std::find(seen_.begin(), seen_.end(), ScanState::kExecuting);
      return seen_.end() - executing > 1 ? std::optional(*(executing + 1)) : std::nullopt;
    };
    seen_changed_.wait_for(lock, std::chrono::seconds(10), [&behind] { return behind().has_value(); });
    return behind();
  }
  void unplug_camera_for_good() {
    const std::lock_guard lock(bench_.mutex);
    bench_.camera_plugged = false;
  }

  [[nodiscard]] MachineView& machine() { return services_->machine; }
  [[nodiscard]] JobService& jobs() { return services_->jobs; }
  [[nodiscard]] TaskService& tasks() { return services_->tasks; }
  [[nodiscard]] Signals signals() { return machine().snapshot()->signals; }

  ScratchDir folder_;
  Config config_;
  sim::FakeClock clock_;
  Bench bench_;
  std::mutex seen_mutex_;
  std::condition_variable seen_changed_;
  std::vector<ScanState> seen_;
  std::unique_ptr<JobStore> store_;
  std::unique_ptr<Engine> engine_;
  std::optional<Services> services_;
};

}  // namespace fvd::test
