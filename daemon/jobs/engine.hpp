#pragma once

/// The job engine: one measurement at a time on devices it keeps open.

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/clock.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/config/config.hpp"
#include "daemon/devices/device_slot.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/pipeline/measurement.hpp"
#include "daemon/pipeline/preview_hub.hpp"
#include "daemon/recipes/recipe.hpp"
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
/// that is missing. It never moves the stage but for a job.
/// context: every public function thread-safe.
class Engine final : public MachineView,
                     public JobService,
                     public ResultService,
                     public TaskService,
                     public RecipeService {
 public:
  Engine(const Config& config, const EngineDependencies& dependencies);
  /// Aborts a running job, which then ends as failed with kShuttingDown, and closes the devices.
  ~Engine() override;

  /// The engine in all its parts, for the API.
  [[nodiscard]] Services services() { return {*this, *this, *this, *this, *this}; }

  Started start(const JobRequest& request) override;
  [[nodiscard]] JobStatus job(const JobKey& key) const override;
  JobStatus abort(const JobKey& key) override;
  [[nodiscard]] std::string result_json(const JobKey& key) const override;
  [[nodiscard]] std::string result_dir(const JobKey& key) const override;
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const override;
  int acknowledge(const JobKey& key) override;
  void prepare(const std::string& recipe_id) override;
  [[nodiscard]] std::vector<std::string> recipe_ids() const override;
  [[nodiscard]] std::string recipe_json(const std::string& recipe_id) const override;
  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override;
  [[nodiscard]] std::optional<StepHistorySummary> stage_history() const override;
  std::shared_ptr<DeviceTask> submit(DeviceTask::Work work) override;
  std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) override;
  void on_change(std::function<void()> listener) override;

  /// Refuses new jobs from now on and aborts the running one; returns at once.
  void shut_down();

 private:
  struct PendingJob {
    JobStatus status;
    Recipe recipe;
  };
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
  void drop_failed_devices(ErrorCode code);
  [[nodiscard]] ErrorCode abort_reason() const;
  [[nodiscard]] MeasurementObserver observer_of_current();
  void end_job(const PendingJob& job, JobState state, std::optional<ErrorCode> error, const std::string& message,
               const std::string& directory, const std::string& result_text);
  void update_current(const std::function<void(JobStatus&)>& change);
  void notify();

  void require_acceptable_locked(const Recipe& recipe) const;
  void require_ready_locked() const;
  [[nodiscard]] Recipe load_checked_recipe_locked(const std::string& recipe_id) const;
  void transition_locked(ScanEvent event);

  const Config& config_;
  JobStore& store_;
  StageHistory stage_history_;
  Clock& clock_;
  WorkerPool pool_;

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  ScanState state_ = ScanState::kPreoperational;  // this and all below up to the listener's mutex: guarded by mutex_
  std::optional<DeviceFacts> facts_;
  std::optional<DeviceFailure> failure_;
  std::optional<PendingJob> pending_;
  std::shared_ptr<DeviceTask> task_;  // waiting or running
  std::stop_source task_stop_;
  std::optional<JobStatus> current_;
  std::string prepared_recipe_;
  std::stop_source job_stop_;
  bool shutting_down_ = false;

  std::mutex listener_mutex_;       // held while the listener runs: once on_change({}) returned, it is not called again
  std::function<void()> listener_;  // guarded by listener_mutex_

  PreviewHub preview_;
  Reaper reaper_;
  DeviceSlot<Camera> camera_;  // engine thread only
  DeviceSlot<Axis> stage_;     // engine thread only
  std::jthread thread_;        // last: ends before anything it uses
};

}  // namespace fvd
