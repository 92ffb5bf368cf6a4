#pragma once

/// The job engine: one measurement at a time on devices it keeps open.

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/config/config.hpp"
#include "daemon/devices/device_slot.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/pipeline/measurement.hpp"
#include "daemon/pipeline/preview_hub.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/recipes/recipe_book.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/store/stage_history.hpp"

namespace fvd {

struct EngineDependencies {
  JobStore& store;
  Clock& clock;
  DeviceSlot<Camera>::Opener open_camera;
  DeviceSlot<Axis>::Opener open_stage;
};

/// Owns the engine thread; that thread alone touches the devices. While no job runs it keeps trying to open a device
/// that is missing. The stage moves for a job or a command (submit()) alone; one that is found moving when it is opened
/// is stopped, and the machine is not ready before its standstill was measured.
/// context: every public function thread-safe.
class Engine final : public MachineView, public JobService, public ResultService, public TaskService {
 public:
  Engine(const Config& config, const EngineDependencies& dependencies);
  /// finish().
  ~Engine() override;

  /// The engine in all its parts, for the API.
  [[nodiscard]] Services services() { return {*this, *this, *this, *this, recipes_}; }

  Started start(const JobRequest& request) override;
  [[nodiscard]] JobStatus job(const JobKey& key) const override;
  JobStatus abort(const JobKey& key) override;
  [[nodiscard]] std::string result_json(const JobKey& key) const override;
  [[nodiscard]] std::string result_dir(const JobKey& key) const override;
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const override;
  int acknowledge(const JobKey& key) override;
  void prepare(const std::string& recipe_id) override;
  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override;
  [[nodiscard]] std::optional<StepHistorySummary> stage_history() const override;
  std::shared_ptr<DeviceTask> submit(DeviceTask::Work work, TaskMotion motion) override;
  std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) override;
  void on_change(std::function<void()> listener) override;

  /// Refuses new jobs from now on and aborts the running one; returns at once.
  void shut_down();
  /// shut_down(), then waits until all has ended and the devices were given up: a running job ends as aborted, one that
  /// had not begun as failed, and a command that had not begun fails, each with kShuttingDown. context: one thread, the
  /// one that destroys the engine.
  void finish();

 private:
  struct PendingJob {
    JobStatus status;
    Recipe recipe;
  };
  /// How a job ended.
  struct JobEnd {
    JobState state = JobState::kFailed;
    std::optional<ErrorCode> error = std::nullopt;
    std::string message = {};
    std::string directory = {};                           ///< empty = no result
    std::string result_text = {};                         ///< of result.json, empty = no result
    std::optional<DeviceFailure> failure = std::nullopt;  ///< why the machine is not ready after it
  };
  enum class Wanted { kJob, kTask };
  /// What is known of the open devices without asking them.
  struct DeviceFacts {
    StageInfo stage;
    int sensor_width = 0;
    int sensor_height = 0;
    bool simulated = false;
  };

  void run(std::stop_token stop);
  void check_devices();
  void run_task(DeviceTask& task, std::stop_token stop);
  void run_job(const PendingJob& job, std::stop_token stop);
  /// Fails what was accepted and has not begun.
  void end_pending();
  /// Opens what is missing; why the machine is not ready, nothing if it is. An axis that moves is stopped.
  [[nodiscard]] std::optional<DeviceFailure> open_devices();
  /// Asks the open stage whether it stands still, and stops it if not.
  [[nodiscard]] std::optional<DeviceFailure> measure_standstill();
  /// The device whose connection was lost since it was opened.
  [[nodiscard]] std::optional<DeviceFailure> lost_device();
  /// After a job or a command that ended by an error: gives up a device that is lost, measures standstill, and says why
  /// the machine is not ready.
  [[nodiscard]] std::optional<DeviceFailure> failure_behind(ErrorCode code, const std::string& message);
  [[nodiscard]] bool at_rest() const;
  void set_at_rest(bool at_rest);
  [[nodiscard]] ErrorCode abort_reason() const;
  [[nodiscard]] MeasurementObserver observer_of_current();
  void end_job(const PendingJob& job, const JobEnd& end);
  void update_current(const std::function<void(JobStatus&)>& change);
  void notify();

  void require_acceptable_locked(const Recipe& recipe) const FVD_REQUIRES(mutex_);
  void require_ready_locked(Wanted wanted) const FVD_REQUIRES(mutex_);
  [[nodiscard]] bool job_runs_locked() const FVD_REQUIRES(mutex_);
  [[nodiscard]] Recipe load_checked_recipe_locked(const std::string& recipe_id) const FVD_REQUIRES(mutex_);
  void transition_locked(ScanEvent event) FVD_REQUIRES(mutex_);
  /// Makes the snapshot anew; called before mutex_ is let go after every change.
  void publish_locked() FVD_REQUIRES(mutex_);

  const Config& config_;
  JobStore& store_;
  RecipeBook recipes_;
  StageHistory stage_history_;
  Clock& clock_;
  WorkerPool pool_;

  mutable Mutex mutex_;
  Condition changed_;
  ScanState state_ FVD_GUARDED_BY(mutex_) = ScanState::kPreoperational;
  std::optional<DeviceFacts> facts_ FVD_GUARDED_BY(mutex_);
  std::optional<DeviceFailure> failure_ FVD_GUARDED_BY(mutex_);
  std::optional<PendingJob> pending_ FVD_GUARDED_BY(mutex_);
  std::shared_ptr<DeviceTask> task_ FVD_GUARDED_BY(mutex_);  // waiting or running
  std::stop_source task_stop_ FVD_GUARDED_BY(mutex_);
  bool recipe_ready_ FVD_GUARDED_BY(mutex_) = false;  // the task that runs leads back to ready, not to initialized
  bool at_rest_ FVD_GUARDED_BY(mutex_) = false;       // standstill was measured since the stage was opened
  std::optional<JobStatus> current_ FVD_GUARDED_BY(mutex_);
  std::string prepared_recipe_ FVD_GUARDED_BY(mutex_);
  std::stop_source job_stop_ FVD_GUARDED_BY(mutex_);
  bool shutting_down_ FVD_GUARDED_BY(mutex_) = false;

  mutable Mutex status_mutex_;  // held for a pointer's copy alone, inside mutex_ or without it
  std::shared_ptr<const MachineStatus> status_ FVD_GUARDED_BY(status_mutex_);

  Mutex listener_mutex_;  // held while the listener runs: once on_change({}) returned, it is not called again
  std::function<void()> listener_ FVD_GUARDED_BY(listener_mutex_);

  PreviewHub preview_;
  Reaper reaper_;
  DeviceSlot<Camera> camera_;  // engine thread only
  DeviceSlot<Axis> stage_;     // engine thread only
  std::jthread thread_;        // last: ends before anything it uses
};

}  // namespace fvd
