/// A command whose stop reaches into the camera, against what ends it: round after round it is met by the camera being
/// given up, by job.start, or by the daemon's end. A use of a camera that is gone is found by the sanitizers, and
/// mostly crashes without them. Prints {"stop_race_rounds": n}.
///
/// stop_race [ROUNDS]: 10,000 by default.

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/jobs/engine.hpp"
#include "sim/fakes/fakes.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {
namespace {

/// interrupt() comes from another thread, as it may.
class RaceCamera final : public sim::FakeCamera {
 public:
  explicit RaceCamera(sim::FakeClock& clock) : FakeCamera(clock, 16, 16), touched_(std::make_unique<Touched>()) {}
  void interrupt() noexcept override {
    for (auto& byte : *touched_) byte.fetch_add(1, std::memory_order_relaxed);
  }

 private:
  using Touched = std::array<std::atomic<unsigned char>, 256>;
  std::unique_ptr<Touched> touched_;
};

enum class Ending { kCameraGivenUp, kJobStarted, kShutDown };

class Race {
 public:
  Race() {
    config_.paths.state_dir = folder_.path();
    config_.paths.recipe_dir = folder_.path();
    config_.compute.threads = 1;
    config_.compute.queue_slices = 64;  // time passes at once here: nobody waits for room in the queue
    std::filesystem::create_directories(folder_.path() / "results");
    write_text(folder_.path() / "part.json", R"({"scan": {"start_um": 0, "step_um": 10, "slices": 3}})");
    store_ = std::make_unique<JobStore>(folder_.path() / "fvd.sqlite");
  }

  void round(Ending ending) {
    if (!engine_) open();
    const auto task = submitted(ending);
    while (!began_) std::this_thread::yield();
    for (auto spins = std::uniform_int_distribution<int>(0, 40)(random_); spins > 0; --spins) std::this_thread::yield();
    if (ending == Ending::kShutDown) {
      engine_->finish();
      engine_.reset();
    } else {
      start_job();
    }
    while (!task->outcome()) std::this_thread::yield();
  }

 private:
  void open() {
    engine_ = std::make_unique<Engine>(
        config_, EngineDependencies{*store_,
                                    clock_,
                                    {.camera = [this] { return std::make_unique<RaceCamera>(clock_); },
                                     .axis = [this] { return std::make_unique<sim::FakeAxis>(clock_); }},
                                    // The race is over when the job measures: no files, so that rounds are many.
                                    [](AtomicDirectory&, const ResultData&, FirstFilesWriter*) -> JobResult {
                                      throw Error(ErrorCode::kBadInput, "this job makes no result");
                                    }});
    engine_->start();
    await_ready();
  }

  void await_ready() {
    while (!engine_->services().machine.snapshot()->signals.ready) std::this_thread::yield();
  }

  /// Ends when it is stopped, or at once by an error for which its camera is given up.
  std::shared_ptr<DeviceTask> submitted(Ending ending) {
    began_ = false;
    const bool gives_up = ending == Ending::kCameraGivenUp;
    const auto work = [this, gives_up](const Devices&, std::stop_token stop) -> std::string {
      began_ = true;
      if (gives_up) throw Error(ErrorCode::kCameraDisconnected, "pulled");
      while (!stop.stop_requested()) std::this_thread::yield();
      throw Error(ErrorCode::kAborted, "stopped");
    };
    while (true) {
      try {
        return engine_->services().tasks.submit(work, TaskMotion::kNone);
      } catch (const Error&) {  // the job before, or a camera that is opened anew
        std::this_thread::yield();
      }
    }
  }

  /// Into the command's end: it may be taken, or find the camera missing.
  void start_job() {
    try {
      const JobStatus job = engine_->services().jobs.start({++seq_, "race", "part"}).job;
      const auto ended = [&] {
        const auto now = engine_->services().machine.snapshot();
        return now->job->job_id != job.job_id || now->job->state != JobState::kProcessing;
      };
      while (!ended()) std::this_thread::yield();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kNotReady) throw;
    }
  }

  ScratchDir folder_;
  Config config_;
  sim::FakeClock clock_;
  std::unique_ptr<JobStore> store_;
  std::unique_ptr<Engine> engine_;
  std::atomic<bool> began_ = false;
  std::int64_t seq_ = 0;
  std::minstd_rand random_{1};
};

}  // namespace
}  // namespace fvd::test

int main(int argc, char** argv) try {
  using namespace fvd::test;
  spdlog::set_level(spdlog::level::off);
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 10'000;
  Race race;
  int done = 0;
  for (; done < rounds; ++done) race.round(static_cast<Ending>(done % 3));
  std::cout << "{\"stop_race_rounds\": " << done << "}" << std::endl;
  return 0;
} catch (const std::exception& error) {
  std::cerr << "stop_race: " << error.what() << '\n';
  return 70;
}
