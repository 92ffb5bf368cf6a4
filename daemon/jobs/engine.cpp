#include "daemon/jobs/engine.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/base/systemd_notify.hpp"
#include "daemon/jobs/device_commands.hpp"
#include "daemon/pipeline/job_memory.hpp"

namespace fvd {

namespace {

int thread_count(int configured) {
  if (configured > 0) return configured;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

Engine::Engine(const Config& config, const EngineDependencies& deps)
    : config_(config),
      store_(deps.store),
      recipes_({config.paths.recipe_dir, config.paths.state_dir / "recipes"},
               {config.stage.min, config.stage.max, config.stage.take_up}, deps.store.recipe_versions()),
      stage_history_(config.paths.state_dir / "stage_history.json"),
      clock_(deps.clock),
      pool_(thread_count(config.compute.threads)),
      current_(deps.store.latest()),
      camera_(deps.open_camera, ErrorCode::kCameraDisconnected, reaper_),
      stage_(deps.open_stage, ErrorCode::kStageDisconnected, reaper_) {
  {
    const MutexLock lock(mutex_);
    publish_locked();
  }
  thread_ = start_thread("fvd-engine", [this](std::stop_token stop) { run(stop); });
}

Engine::~Engine() { finish(); }

void Engine::shut_down() {
  {
    const MutexLock lock(mutex_);
    shutting_down_ = true;
    transition_locked(ScanEvent::kHalt);
    job_stop_.request_stop();
    task_stop_.request_stop();
    publish_locked();
  }
  thread_.request_stop();
  notify();
}

void Engine::finish() {
  shut_down();
  if (thread_.joinable()) thread_.join();
}

// --- requests, on any thread ---------------------------------------------------------------------------------------

JobService::Started Engine::start(const JobRequest& request) {
  Started started;
  {
    const MutexLock lock(mutex_);
    if (auto known = store_.find_repeated(request)) {
      // The running job is known better here than in the database.
      return {current_ && current_->job_id == known->job_id ? *current_ : *known, true};
    }
    require_ready_locked(Wanted::kJob);
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
    publish_locked();
    started.job = std::move(job);
  }
  changed_.notify_all();
  notify();
  return started;
}

void Engine::require_ready_locked(Wanted wanted) const {
  if (shutting_down_) throw Error(ErrorCode::kShuttingDown, "the daemon is shutting down and takes no more jobs");
  switch (state_) {
    case ScanState::kInitialized:
    case ScanState::kReady:
      return;
    case ScanState::kExecuting:
      if (job_runs_locked()) {
        throw Error(ErrorCode::kBusy, "job " + current_->job_id + " is running; wait for it to end");
      }
      if (wanted == Wanted::kJob) return;  // a job ends the command that runs
      throw Error(ErrorCode::kBusy, "the devices are busy with another command; try again when it is done");
    case ScanState::kPreoperational:
      throw Error(ErrorCode::kNotReady, "the devices are still being opened");
    case ScanState::kError:
      throw Error(ErrorCode::kNotReady, failure_ ? failure_->message : "a device is missing");
    case ScanState::kHalted:
      throw Error(ErrorCode::kNotReady, "the machine is halted");
  }
}

bool Engine::job_runs_locked() const { return current_ && current_->state == JobState::kProcessing; }

Recipe Engine::load_checked_recipe_locked(const std::string& recipe_id) const {
  if (recipe_id.empty()) {
    throw Error(ErrorCode::kUnknownRecipe, "no recipe is named and none is prepared: name one or call recipe.prepare");
  }
  Recipe recipe = recipes_.load(recipe_id);
  require_acceptable_locked(recipe);
  return recipe;
}

void Engine::require_acceptable_locked(const Recipe& recipe) const {
  if (!facts_) throw Error(ErrorCode::kNotReady, "a device is being opened anew; try again when the machine is ready");
  if (recipe.mode == ScanMode::kContinuous) check_continuous(scan_plan(recipe), recipe.camera, facts_->stage);
  check_plan(scan_plan(recipe), facts_->stage);
  const int width = recipe.camera.width > 0 ? recipe.camera.width : facts_->sensor_width;
  const int height = recipe.camera.height > 0 ? recipe.camera.height : facts_->sensor_height;
  const std::size_t budget = static_cast<std::size_t>(config_.compute.memory_budget_mib) << 20U;
  require_memory(job_memory(recipe, width, height, pool_.threads()), width, height, budget);
}

JobStatus Engine::job(const JobKey& key) const {
  {
    const MutexLock lock(mutex_);
    if (current_ && names(key, *current_)) return *current_;
  }
  return store_.find(key).status;
}

JobStatus Engine::abort(const JobKey& key) {
  {
    const MutexLock lock(mutex_);
    if (current_ && names(key, *current_)) {
      if (current_->state == JobState::kProcessing) job_stop_.request_stop();
      return *current_;
    }
  }
  return store_.find(key).status;
}

std::optional<StepHistorySummary> Engine::stage_history() const { return stage_history_.summary(); }

std::string Engine::result_json(const JobKey& key) const { return store_.find(key).result_json; }

std::string Engine::result_dir(const JobKey& key) const { return store_.find(key).result_dir; }

std::optional<JobStatus> Engine::next_unacknowledged() const { return store_.next_unacknowledged(); }

int Engine::acknowledge(const JobKey& key) {
  {
    const MutexLock lock(mutex_);
    if (current_ && names(key, *current_) && current_->state == JobState::kProcessing) {
      throw Error(ErrorCode::kBusy, "job " + current_->job_id + " is still running; acknowledge it when it has ended");
    }
  }
  const int remaining = store_.acknowledge(key);  // not under the lock: a scan that runs would wait for the disk
  {
    const MutexLock lock(mutex_);
    if (current_ && names(key, *current_)) current_->acknowledged = true;
    publish_locked();
  }
  notify();
  return remaining;
}

void Engine::prepare(const std::string& recipe_id) {
  {
    const MutexLock lock(mutex_);
    require_ready_locked(Wanted::kJob);
    prepared_recipe_ = load_checked_recipe_locked(recipe_id).id;
    recipe_ready_ = true;  // where a command that runs leads
    transition_locked(ScanEvent::kRecipePrepared);
    publish_locked();
  }
  notify();
}

std::shared_ptr<const MachineStatus> Engine::snapshot() const {
  const MutexLock lock(status_mutex_);
  return status_;
}

void Engine::publish_locked() {
  auto status = std::make_shared<MachineStatus>();
  status->state = state_;
  status->recipe = prepared_recipe_;
  status->job = current_;
  status->results_waiting = store_.unacknowledged_count();
  status->simulated = config_.camera.simulated || config_.stage.simulated || (facts_ && facts_->simulated);
  status->epoch = store_.epoch();
  status->part_free = at_rest_ && !(task_ && task_->moves()) && !(job_runs_locked() && !current_->acquired);
  if (failure_) {
    status->error = failure_->code;
    status->error_message = failure_->message;
  }
  const bool part_free = status->part_free;
  bool changed = false;
  {
    const MutexLock lock(status_mutex_);
    changed = !status_ || status_->part_free != part_free;
    status_ = std::move(status);
  }
  if (changed) spdlog::info("part_release {}", part_free);  // no reader waits for the log
}

std::shared_ptr<DeviceTask> Engine::submit(DeviceTask::Work work, TaskMotion motion) {
  std::shared_ptr<DeviceTask> task;
  {
    const MutexLock lock(mutex_);
    require_ready_locked(Wanted::kTask);
    if (task_) throw Error(ErrorCode::kBusy, "the devices are busy with another command; try again when it is done");
    task = task_ = std::make_shared<DeviceTask>(std::move(work), motion);
    task_stop_ = std::stop_source();
    recipe_ready_ = state_ == ScanState::kReady;
    if (task->moves()) transition_locked(ScanEvent::kTaskStarted);
    publish_locked();  // before anything can move
  }
  changed_.notify_all();
  notify();
  return task;
}

std::shared_ptr<DeviceTask> Engine::preview(const CameraSettings& settings) {
  const auto now = snapshot();
  if (!now->job || now->job->state != JobState::kProcessing) return submit(preview_work(settings), TaskMotion::kNone);
  auto picture = preview_.newest();
  if (!picture) throw Error(ErrorCode::kBusy, "the job has shown no slice yet; ask again");
  return std::make_shared<DeviceTask>(DeviceTask::Outcome{std::move(*picture), std::nullopt, {}});
}

void Engine::on_change(std::function<void()> listener) {
  const MutexLock lock(listener_mutex_);
  listener_ = std::move(listener);
}

void Engine::notify() {
  const MutexLock lock(listener_mutex_);
  if (listener_) listener_();
}

void Engine::transition_locked(ScanEvent event) {
  const auto next = next_state(state_, event);
  if (!next || *next == state_) return;
  spdlog::info("state {} -> {}", scan_state_name(state_), scan_state_name(*next));
  state_ = *next;
  notify_status(std::string(scan_state_name(state_)));
}

}  // namespace fvd
