#include "daemon/jobs/engine.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <pthread.h>
#include <spdlog/spdlog.h>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/base/systemd_notify.hpp"
#include "daemon/base/version.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/jobs/device_commands.hpp"
#include "daemon/pipeline/job_memory.hpp"
#include "daemon/recipes/recipe_book.hpp"

namespace fvd {

namespace {

/// How often an idle engine looks after its devices, and how often when one is missing.
constexpr std::chrono::milliseconds kDeviceCheckPeriod{500};
constexpr std::chrono::milliseconds kDeviceRetryPeriod{200};

int thread_count(int configured) {
  if (configured > 0) return configured;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool matches(const JobStatus& job, const JobKey& key) {
  if (const auto* id = std::get_if<std::string>(&key)) return job.job_id == *id;
  return job.request.seq == std::get<std::int64_t>(key);
}

}  // namespace

Engine::Engine(const Config& config, const EngineDependencies& deps)
    : config_(config),
      store_(deps.store),
      stage_history_(config.paths.state_dir / "stage_history.json"),
      clock_(deps.clock),
      pool_(thread_count(config.compute.threads)),
      current_(deps.store.latest()),
      camera_(deps.open_camera, ErrorCode::kCameraDisconnected, reaper_),
      stage_(deps.open_stage, ErrorCode::kStageDisconnected, reaper_),
      thread_([this](std::stop_token stop) { run(stop); }) {
  pthread_setname_np(thread_.native_handle(), "fvd-engine");
}

Engine::~Engine() { shut_down(); }

void Engine::shut_down() {
  {
    const std::lock_guard lock(mutex_);
    shutting_down_ = true;
    transition_locked(ScanEvent::kHalt);
    job_stop_.request_stop();
    task_stop_.request_stop();
  }
  thread_.request_stop();
  notify();
}

// --- requests, on any thread ---------------------------------------------------------------------------------------

JobService::Started Engine::start(const JobRequest& request) {
  Started started;
  {
    const std::lock_guard lock(mutex_);
    if (auto known = store_.find_repeated(request)) {
      // The running job is known better here than in the database.
      return {current_ && current_->job_id == known->job_id ? *current_ : *known, true};
    }
    require_ready_locked();
    const Recipe recipe = load_checked_recipe_locked(request.recipe.empty() ? prepared_recipe_ : request.recipe);
    JobRequest resolved = request;
    resolved.recipe = recipe.id;
    JobStatus job = store_.accept(resolved);
    job.slices_planned = recipe.slices;
    job.phase = "preparing";
    transition_locked(ScanEvent::kJobStarted);
    prepared_recipe_ = recipe.id;
    current_ = job;
    job_stop_ = std::stop_source();
    pending_ = PendingJob{job, recipe};
    task_stop_.request_stop();  // measuring comes first
    started.job = std::move(job);
  }
  changed_.notify_all();
  notify();
  return started;
}

void Engine::require_ready_locked() const {
  if (shutting_down_) throw Error(ErrorCode::kShuttingDown, "the daemon is shutting down and takes no more jobs");
  switch (state_) {
    case ScanState::kInitialized:
    case ScanState::kReady:
      return;
    case ScanState::kExecuting:
      throw Error(ErrorCode::kBusy, "job " + (current_ ? current_->job_id : "") + " is running; wait for it to end");
    case ScanState::kPreoperational:
      throw Error(ErrorCode::kNotReady, "the devices are still being opened");
    case ScanState::kError:
      throw Error(ErrorCode::kNotReady, failure_ ? failure_->message : "a device is missing");
    case ScanState::kHalted:
      throw Error(ErrorCode::kNotReady, "the machine is halted");
  }
}

Recipe Engine::load_checked_recipe_locked(const std::string& recipe_id) const {
  if (recipe_id.empty()) {
    throw Error(ErrorCode::kUnknownRecipe, "no recipe is named and none is prepared: name one or call recipe.prepare");
  }
  Recipe recipe = load_recipe(config_.paths.recipe_dir, recipe_id);
  require_acceptable_locked(recipe);
  return recipe;
}

void Engine::require_acceptable_locked(const Recipe& recipe) const {
  if (!facts_) return;
  if (recipe.mode == ScanMode::kContinuous) check_continuous(scan_plan(recipe), recipe.camera, facts_->stage);
  check_plan(scan_plan(recipe), facts_->stage);
  const int width = recipe.camera.width > 0 ? recipe.camera.width : facts_->sensor_width;
  const int height = recipe.camera.height > 0 ? recipe.camera.height : facts_->sensor_height;
  const std::size_t budget = static_cast<std::size_t>(config_.compute.memory_budget_mib) << 20U;
  require_memory(job_memory(recipe, width, height, pool_.threads()), width, height, budget);
}

JobStatus Engine::job(const JobKey& key) const {
  const std::lock_guard lock(mutex_);
  if (current_ && matches(*current_, key)) return *current_;
  return store_.find(key).status;
}

JobStatus Engine::abort(const JobKey& key) {
  const std::lock_guard lock(mutex_);
  if (current_ && matches(*current_, key)) {
    if (current_->state == JobState::kProcessing) job_stop_.request_stop();
    return *current_;
  }
  return store_.find(key).status;
}

std::optional<StepHistorySummary> Engine::stage_history() const { return stage_history_.summary(); }

std::string Engine::result_json(const JobKey& key) const { return store_.find(key).result_json; }

std::string Engine::result_dir(const JobKey& key) const { return store_.find(key).result_dir; }

std::optional<JobStatus> Engine::next_unacknowledged() const { return store_.next_unacknowledged(); }

int Engine::acknowledge(const JobKey& key) {
  int remaining = 0;
  {
    const std::lock_guard lock(mutex_);
    if (current_ && matches(*current_, key) && current_->state == JobState::kProcessing) {
      throw Error(ErrorCode::kBusy, "job " + current_->job_id + " is still running; acknowledge it when it has ended");
    }
    remaining = store_.acknowledge(key);
    if (current_ && matches(*current_, key)) current_->acknowledged = true;
  }
  notify();
  return remaining;
}

void Engine::prepare(const std::string& recipe_id) {
  {
    const std::lock_guard lock(mutex_);
    require_ready_locked();
    prepared_recipe_ = load_checked_recipe_locked(recipe_id).id;
    transition_locked(ScanEvent::kRecipePrepared);
  }
  notify();
}

std::vector<std::string> Engine::recipe_ids() const { return list_recipes(config_.paths.recipe_dir); }

std::string Engine::recipe_json(const std::string& recipe_id) const {
  return recipe_text(config_.paths.recipe_dir, recipe_id);
}

std::shared_ptr<const MachineStatus> Engine::snapshot() const {
  const std::lock_guard lock(mutex_);
  MachineStatus status;
  status.state = state_;
  status.recipe = prepared_recipe_;
  status.job = current_;
  status.results_waiting = store_.unacknowledged_count();
  status.simulated = config_.camera.simulated || config_.stage.simulated || (facts_ && facts_->simulated);
  status.epoch = store_.epoch();
  if (failure_) {
    status.error = failure_->code;
    status.error_message = failure_->message;
  }
  return std::make_shared<const MachineStatus>(std::move(status));
}

std::shared_ptr<DeviceTask> Engine::submit(DeviceTask::Work work) {
  std::shared_ptr<DeviceTask> task;
  {
    const std::lock_guard lock(mutex_);
    require_ready_locked();
    if (task_) throw Error(ErrorCode::kBusy, "the devices are busy with another command; try again when it is done");
    task = task_ = std::make_shared<DeviceTask>(std::move(work));
    task_stop_ = std::stop_source();
  }
  changed_.notify_all();
  return task;
}

std::shared_ptr<DeviceTask> Engine::preview(const CameraSettings& settings) {
  if (snapshot()->state != ScanState::kExecuting) return submit(preview_work(settings));
  auto picture = preview_.newest();
  if (!picture) throw Error(ErrorCode::kBusy, "the job has shown no slice yet; ask again");
  return std::make_shared<DeviceTask>(DeviceTask::Outcome{std::move(*picture), std::nullopt, {}});
}

void Engine::on_change(std::function<void()> listener) {
  const std::lock_guard lock(listener_mutex_);
  listener_ = std::move(listener);
}

void Engine::notify() {
  const std::lock_guard lock(listener_mutex_);
  if (listener_) listener_();
}

void Engine::transition_locked(ScanEvent event) {
  const auto next = next_state(state_, event);
  if (!next || *next == state_) return;
  spdlog::info("state {} -> {}", scan_state_name(state_), scan_state_name(*next));
  state_ = *next;
  notify_status(std::string(scan_state_name(state_)));
}

// --- the engine's thread -------------------------------------------------------------------------------------------

void Engine::run(std::stop_token stop) {
  while (!stop.stop_requested()) {
    check_devices();
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, failure_ ? kDeviceRetryPeriod : kDeviceCheckPeriod,
                      [this] { return pending_.has_value() || task_ != nullptr; });
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
  camera_.drop();
  stage_.drop();
}

void Engine::run_task(DeviceTask& task, std::stop_token stop) {
  if (stop.stop_requested()) {
    task.fail(ErrorCode::kAborted, "a job was started before the command could begin");
  } else if (!camera_.ensure() || !stage_.ensure()) {
    task.fail(ErrorCode::kNotReady, "a device is missing");
  } else {
    const std::stop_callback wake(stop, [this] { camera_.get().interrupt(); });
    task.run({camera_.get(), stage_.get(), clock_, config_.paths.state_dir}, stop);
    const auto outcome = task.outcome();
    if (outcome && outcome->error) drop_failed_devices(*outcome->error);
  }
  {
    const std::lock_guard lock(mutex_);
    task_.reset();
  }
  notify();
}

void Engine::check_devices() {
  const bool camera_up = camera_.ensure();
  const bool stage_up = stage_.ensure();
  std::optional<DeviceFailure> failure;
  std::optional<DeviceFacts> facts;
  if (!camera_up) {
    failure = camera_.failure();
  } else if (!stage_up) {
    failure = stage_.failure();
  } else {
    const CameraInfo camera = camera_.get().info();
    facts = DeviceFacts{stage_.get().info(), camera.sensor_width, camera.sensor_height, camera.simulated};
    facts->simulated = facts->simulated || facts->stage.simulated;
  }
  bool changed = false;
  {
    const std::lock_guard lock(mutex_);
    const ScanState before = state_;
    if (state_ != ScanState::kExecuting) {
      transition_locked(failure ? ScanEvent::kDevicesDown : ScanEvent::kDevicesUp);
    }
    if (failure && failure != failure_) spdlog::warn("{}: {}", error_name(failure->code), failure->message);
    changed = before != state_ || failure != failure_;
    failure_ = failure;
    facts_ = facts;
  }
  if (changed) notify();
}

MeasurementObserver Engine::observer_of_current() {
  MeasurementObserver observer;
  observer.on_phase = [this](std::string_view phase) {
    update_current([phase](JobStatus& job) { job.phase = phase; });
  };
  observer.on_slice = [this](const ScanReport& report) {
    update_current([&report](JobStatus& job) {
      job.slices_done = static_cast<int>(report.steps.size());
      job.frames = report.frames;
    });
  };
  observer.on_acquired = [this] { update_current([](JobStatus& job) { job.acquired = true; }); };
  return observer;
}

void Engine::run_job(const PendingJob& job, std::stop_token stop) {
  spdlog::info("job {} starts: seq {}, part '{}', recipe {}", job.status.job_id, job.status.request.seq,
               job.status.request.part_id, job.recipe.id);
  preview_.clear();
  ResultData result;
  result.software_version = kVersion;
  result.created = std::chrono::system_clock::now();
  result.simulated = config_.camera.simulated || config_.stage.simulated;
  result.job_id = job.status.job_id;
  result.seq = job.status.request.seq;
  result.part_id = job.status.request.part_id;
  result.recipe_id = job.recipe.id;
  result.recipe_sha256 = job.recipe.sha256;
  result.focus = focus_settings(job.recipe);
  result.peak = job.recipe.peak;
  result.pixel_pitch_x_um = job.recipe.pixel_pitch_x_um;
  result.pixel_pitch_y_um = job.recipe.pixel_pitch_y_um;
  try {
    if (!camera_.ensure()) throw Error(camera_.failure()->code, camera_.failure()->message);
    if (!stage_.ensure()) throw Error(stage_.failure()->code, stage_.failure()->message);
    AtomicDirectory directory(config_.paths.state_dir / "results" / job.status.job_id);
    MeasurementObserver observer = observer_of_current();
    std::optional<SliceRecorder> recorder;
    if (job.recipe.record_slices) recorder.emplace(directory);
    observer.tap = [&recorder, this](const ImageView& pixels, double z_um) {
      if (recorder) recorder->add(pixels, z_um);
      preview_.offer(pixels, z_um);
    };
    measure(job.recipe,
            {camera_.get(), stage_.get(), clock_, pool_, static_cast<std::size_t>(config_.compute.queue_slices),
             config_.camera.time_offset},
            observer, result, stop);
    observer.on_phase("storing");
    // In a continuous scan nobody commands the stage to be just there.
    if (job.recipe.mode == ScanMode::kStep) stage_history_.add(stage_.get().info().feedback, result.steps);
    if (recorder) recorder->finish("job " + job.status.job_id + (result.simulated ? ", simulated" : ""));
    write_result(directory, result);
    directory.commit();
    const std::string text = read_text_file(directory.final_dir() / "result.json");
    std::optional<ErrorCode> verdict;
    std::string message;
    try {
      check_valid_points(job.recipe, result.map);
    } catch (const Error& error) {
      verdict = error.code();
      message = error.what();
    }
    end_job(job, verdict ? JobState::kFailed : JobState::kCompleted, verdict, message, directory.final_dir().string(),
            text);
  } catch (const Error& error) {
    drop_failed_devices(error.code());
    const bool aborted = error.code() == ErrorCode::kAborted;
    end_job(job, aborted ? JobState::kAborted : JobState::kFailed, aborted ? abort_reason() : error.code(),
            error.what(), {}, {});
  } catch (const std::exception& error) {
    end_job(job, JobState::kFailed, ErrorCode::kInternal, error.what(), {}, {});
  }
}

ErrorCode Engine::abort_reason() const {
  const std::lock_guard lock(mutex_);
  return shutting_down_ ? ErrorCode::kShuttingDown : ErrorCode::kAborted;
}

void Engine::drop_failed_devices(ErrorCode code) {
  if (code == ErrorCode::kCameraDisconnected || code == ErrorCode::kCameraFramesLost) camera_.drop();
  if (code == ErrorCode::kStageDisconnected) stage_.drop();
}

void Engine::end_job(const PendingJob& job, JobState state, std::optional<ErrorCode> error, const std::string& message,
                     const std::string& directory, const std::string& result_text) {
  if (error) {
    spdlog::error("job {} {}: {}: {}", job.status.job_id, job_state_name(state), error_name(*error), message);
  } else {
    spdlog::info("job {} completed: {}", job.status.job_id, directory);
  }
  JobStatus ended;
  {
    const std::lock_guard lock(mutex_);
    ended = *current_;
  }
  ended.state = state;
  ended.phase.clear();
  ended.acquired = true;
  ended.error = error;
  ended.error_message = message;
  // The row is durable before anybody can see the job's end; a database that fails must not hide that it ended.
  try {
    store_.finish(ended, directory, result_text);
  } catch (const Error& failure) {
    spdlog::critical("job {}: its end could not be stored: {}", ended.job_id, failure.what());
    ended.state = JobState::kFailed;
    ended.error = failure.code();
    ended.error_message = failure.what();
  }
  {
    const std::lock_guard lock(mutex_);
    current_ = ended;
    transition_locked(ScanEvent::kJobEnded);
  }
  notify();
}

void Engine::update_current(const std::function<void(JobStatus&)>& change) {
  {
    const std::lock_guard lock(mutex_);
    change(*current_);
  }
  notify();
}

}  // namespace fvd
