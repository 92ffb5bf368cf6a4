/// The engine's thread: its loop, the devices it keeps open, the commands between the jobs.

#include <chrono>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/jobs/engine.hpp"

namespace fvd {

namespace {

/// How often an idle engine looks after its devices, and how often when one is missing.
constexpr std::chrono::milliseconds kDeviceCheckPeriod{500};
constexpr std::chrono::milliseconds kDeviceRetryPeriod{200};

bool moves(const StageStatus& stage) {
  return stage.moving || stage.state == AxisState::kMoving || stage.state == AxisState::kHoming;
}

/// An axis that was told to stop comes to rest within this; one that does not is looked at again at the next check.
constexpr std::chrono::milliseconds kStopTime{500};
/// Standstill is two looks in a row, this far apart, at an axis that says it rests and measures the same position: a
/// drive may report standstill before it starts, or late.
constexpr std::chrono::milliseconds kStandstillPoll{20};
constexpr double kStandstillWindow_um = 1.0;

DeviceFailure moving_on() {
  return {ErrorCode::kNotReady, "the stage was found moving and is being stopped; wait until it rests"};
}

}  // namespace

void Engine::run(std::stop_token stop) {
  while (!stop.stop_requested()) {
    check_devices();
    MutexLock lock(mutex_);
    changed_.wait_for(lock, stop, failure_ ? kDeviceRetryPeriod : kDeviceCheckPeriod, [this] {
      mutex_.assert_held();
      return pending_.has_value() || task_ != nullptr;
    });
    if (stop.stop_requested()) break;
    if (task_) {
      const auto task = task_;
      const auto task_stop = task_stop_.get_token();
      lock.unlock();
      run_task(*task, task_stop);
      continue;
    }
    if (!pending_) continue;
    const PendingJob job = std::move(*pending_);
    pending_.reset();
    const auto job_stop = job_stop_.get_token();
    lock.unlock();
    run_job(job, job_stop);
  }
  end_pending();
  camera_.drop();
  stage_.drop();
}

void Engine::end_pending() {
  std::shared_ptr<DeviceTask> task;
  std::optional<PendingJob> job;
  {
    const MutexLock lock(mutex_);
    task = std::exchange(task_, nullptr);
    job = std::exchange(pending_, std::nullopt);
  }
  const std::string message = "the daemon was shut down before this could begin; ask again when it is back";
  if (task) task->fail(ErrorCode::kShuttingDown, message);
  if (job) {
    end_job(*job, {.state = JobState::kFailed, .error = ErrorCode::kShuttingDown, .message = message});
  }
  notify();
}

void Engine::run_task(DeviceTask& task, std::stop_token stop) {
  std::optional<DeviceFailure> failure;
  DeviceTask::Outcome outcome;
  if (stop.stop_requested()) {
    outcome = {{}, abort_reason(), "a job was started, or the daemon was shut down, before the command could begin"};
  } else if ((failure = open_devices())) {
    outcome = {{}, ErrorCode::kNotReady, failure->message};
  } else {
    {
      // Gone before a camera may be dropped: its end waits for a call that is under way.
      const std::stop_callback wake(stop, [this] { camera_.get().interrupt(); });
      outcome = task.perform({camera_.get(), stage_.get(), clock_, config_.paths.state_dir}, stop);
    }
    failure = outcome.error ? failure_behind(*outcome.error, outcome.message) : lost_device();
  }
  {
    const MutexLock lock(mutex_);
    task_.reset();
    if (failure) failure_ = failure;
    if (!job_runs_locked()) {
      if (failure) {
        transition_locked(ScanEvent::kDevicesDown);
      } else {
        transition_locked(recipe_ready_ ? ScanEvent::kTaskEndedPrepared : ScanEvent::kTaskEnded);
      }
    }
    publish_locked();
  }
  task.end(std::move(outcome));  // whoever reads it finds the devices free
  notify();
}

void Engine::check_devices() {
  const std::optional<DeviceFailure> failure = open_devices();
  std::optional<DeviceFacts> facts;
  if (!failure) {
    const CameraInfo camera = camera_.get().info();
    facts = DeviceFacts{stage_.get().info(), camera.sensor_width, camera.sensor_height, camera.simulated};
    facts->simulated = facts->simulated || facts->stage.simulated;
  }
  bool changed = false;
  {
    const MutexLock lock(mutex_);
    const ScanState before = state_;
    if (state_ != ScanState::kExecuting) {
      transition_locked(failure ? ScanEvent::kDevicesDown : ScanEvent::kDevicesUp);
    }
    if (failure && failure != failure_) spdlog::warn("{}: {}", error_name(failure->code), failure->message);
    changed = before != state_ || failure != failure_;
    failure_ = failure;
    facts_ = facts;
    publish_locked();
  }
  if (changed) notify();
}

std::optional<DeviceFailure> Engine::open_devices() {
  // The stage first: an axis that moves on from before is stopped before a camera is waited for.
  const int openings = stage_.openings();
  if (!stage_.connected()) set_at_rest(false);
  std::optional<DeviceFailure> stage_failure;
  if (!stage_.ensure()) {
    stage_failure = stage_.failure();
  } else if (stage_.openings() != openings || !at_rest()) {
    stage_failure = measure_standstill();
  }
  if (!camera_.ensure()) return camera_.failure();
  return stage_failure;
}

std::optional<DeviceFailure> Engine::measure_standstill() {
  try {
    const auto deadline = std::chrono::steady_clock::now() + kStopTime;
    std::optional<Micrometers> resting;
    bool told_to_stop = false;
    for (;;) {
      const StageStatus status = stage_.get().status();
      if (moves(status)) {
        set_at_rest(false);
        if (!std::exchange(told_to_stop, true)) stage_.get().stop();
        resting.reset();
      } else if (resting && std::abs(status.position.value - resting->value) <= kStandstillWindow_um) {
        set_at_rest(true);
        return std::nullopt;
      } else {
        resting = status.position;
      }
      if (std::chrono::steady_clock::now() > deadline) break;
      std::this_thread::sleep_for(kStandstillPoll);
    }
    set_at_rest(false);
    if (!told_to_stop) stage_.get().stop();  // it creeps, though it says that it rests
    return moving_on();
  } catch (const Error& error) {
    set_at_rest(false);
    if (error.code() == ErrorCode::kStageDisconnected) stage_.drop();
    return DeviceFailure{error.code(), error.what()};
  } catch (const std::exception& error) {
    set_at_rest(false);
    return DeviceFailure{ErrorCode::kInternal, error.what()};
  }
}

std::optional<DeviceFailure> Engine::lost_device() {
  if (!stage_.connected()) {
    set_at_rest(false);
    return DeviceFailure{ErrorCode::kStageDisconnected, "the connection was lost"};
  }
  if (!camera_.connected()) return DeviceFailure{ErrorCode::kCameraDisconnected, "the connection was lost"};
  return std::nullopt;
}

std::optional<DeviceFailure> Engine::failure_behind(ErrorCode code, const std::string& message) {
  if (code == ErrorCode::kStageDisconnected) {
    stage_.drop();
    set_at_rest(false);
    return DeviceFailure{code, message};
  }
  std::optional<DeviceFailure> failure = lost_device();
  if (stage_.connected()) {
    if (auto moving = measure_standstill()) failure = moving;
  }
  if (code == ErrorCode::kCameraDisconnected) {
    camera_.drop();
    return DeviceFailure{code, message};
  }
  if (failure) return failure;
  if (code == ErrorCode::kCameraFramesLost) {
    camera_.drop();
    if (!camera_.ensure()) return camera_.failure();
  }
  return std::nullopt;
}

bool Engine::at_rest() const {
  const MutexLock lock(mutex_);
  return at_rest_;
}

void Engine::set_at_rest(bool at_rest) {
  {
    const MutexLock lock(mutex_);
    if (at_rest_ == at_rest) return;
    at_rest_ = at_rest;
    publish_locked();
  }
  notify();
}

}  // namespace fvd
