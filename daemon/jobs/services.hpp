#pragma once

/// What the API needs, a narrow interface for each concern; tests put fakes in their place.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/hw/camera.hpp"
#include "core/stage/step_history.hpp"
#include "daemon/config/config.hpp"
#include "daemon/jobs/device_task.hpp"
#include "daemon/jobs/machine_state.hpp"
#include "daemon/recipes/recipe_service.hpp"
#include "daemon/store/job_status.hpp"
#include "daemon/store/objective_table.hpp"
#include "daemon/study/study_desk.hpp"

namespace fvd {

struct MachineStatus {
  ScanState state = ScanState::kPreoperational;
  std::string recipe;            ///< prepared recipe, empty = none
  std::string objective;         ///< confirmed objective, empty = none
  std::optional<JobStatus> job;  ///< the running or the latest job
  Signals signals;
  int results_waiting = 0;  ///< completed and not acknowledged
  bool simulated = false;
  std::int64_t epoch = 0;          ///< counts the daemon's starts
  std::optional<ErrorCode> error;  ///< why the state is kError
  std::string error_message;
  std::optional<CameraInfo> camera;  ///< that is open
};

/// What readers poll: made anew at every change, never waited for.
class MachineView {
 public:
  virtual ~MachineView() = default;
  /// No lock that is held across a database or file access; never null.
  [[nodiscard]] virtual std::shared_ptr<const MachineStatus> snapshot() const = 0;
  /// Called after every change of a job or the machine, from any thread; must return at once. Set before use.
  virtual void on_change(std::function<void()> listener) = 0;
};

/// Accepts jobs and tells of them.
/// context: every function thread-safe; blocks for files and a database commit, so never called on the network thread.
/// Nobody else waits for that: no lock is held meanwhile.
class JobService {
 public:
  virtual ~JobService() = default;

  struct Started {
    JobStatus job;
    bool duplicate = false;
  };
  /// Accepts a job and returns after its row is durable; the scan runs later on the machine's thread. A repeated
  /// request returns the existing job, also while the first is still being made durable: it waits for it then. Throws
  /// Error kNotReady, kBusy, kUnknownRecipe, kBadRecipe, kStageLimit, kObjectiveMismatch, kRegionOutside,
  /// kMemoryBudget, kSeqConflict, kSeqStale, kStorageFull, kDatabase, kShuttingDown.
  virtual Started start(const JobRequest& request) = 0;

  /// Throws Error kUnknownJob.
  [[nodiscard]] virtual JobStatus job(const JobKey& key) const = 0;

  /// The client's job with the highest sequence number.
  [[nodiscard]] virtual std::optional<JobStatus> highest(const std::string& client) const = 0;

  /// Asks the job to end; returns at once with its status. No effect on a job that has ended. Throws Error kUnknownJob.
  virtual JobStatus abort(const JobKey& key) = 0;

  /// Loads and checks a recipe and makes it the prepared one. Throws Error kUnknownRecipe, kBadRecipe, kStageLimit,
  /// kObjectiveMismatch, kRegionOutside, kMemoryBudget, kBusy.
  virtual void prepare(const std::string& recipe_id) = 0;
};

/// Results of jobs that ended.
/// context: as JobService.
class ResultService {
 public:
  virtual ~ResultService() = default;

  /// The job, its result's folder and the text of its result.json, of one moment; for the id of an evaluation the job
  /// as it is told with that id, the evaluation's recipe, folder and text. Throws Error kUnknownJob.
  [[nodiscard]] virtual StoredJob stored(const JobKey& key) const = 0;

  /// The oldest ended job that was not acknowledged.
  [[nodiscard]] virtual std::optional<JobStatus> next_unacknowledged() const = 0;

  /// Returns how many remain. Repeating it changes nothing. Throws Error kUnknownJob, kBusy while the job runs.
  virtual int acknowledge(const JobKey& key) = 0;

  /// Evaluates the result's surface by another recipe into a record of its own; see ResultEvaluator. Throws Error
  /// kUnknownJob, kUnknownRecipe, kBadRecipe, kBadInput, kMemoryBudget, kBusy, kShuttingDown.
  [[nodiscard]] virtual std::shared_ptr<DeviceTask> evaluate(const JobKey& key, const std::string& recipe_id) = 0;
};

/// Commands to the devices between the jobs.
/// context: every function thread-safe.
class TaskService {
 public:
  virtual ~TaskService() = default;

  /// Does something with the devices as soon as they are free; a job that is started meanwhile ends it. Throws
  /// Error kBusy while a job runs or another task waits, kNotReady without the devices, kShuttingDown.
  virtual std::shared_ptr<DeviceTask> submit(DeviceTask::Work work, TaskMotion motion) = 0;
  /// As submit(preview_work(settings)); while a job runs, the newest of its slices instead, scaled down.
  virtual std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) = 0;

  /// What all scans so far say of the stage; nothing before the first.
  [[nodiscard]] virtual std::optional<StepHistorySummary> stage_history() const = 0;
};

/// Which objective is on the microscope, as people confirm it.
/// context: as JobService.
class ObjectiveService {
 public:
  virtual ~ObjectiveService() = default;

  struct Known {
    std::vector<ObjectiveConfig> objectives;         ///< that the configuration names
    std::optional<ObjectiveConfirmation> confirmed;  ///< of one of these; nothing = nobody confirmed one yet
  };
  [[nodiscard]] virtual Known known() const = 0;

  /// Durable at the return: a restart does not change it. person: who says so. Throws Error kBadInput for a name that
  /// the configuration has not, kBusy while a job or a command runs, kShuttingDown, kDatabase, kStorageFull.
  virtual ObjectiveConfirmation confirm(const std::string& name, const std::string& person) = 0;
};

/// Studies of jobs, and the constants of the instrument.
/// context: every function thread-safe; begin() blocks for nothing, the others for files.
class StudyService {
 public:
  virtual ~StudyService() = default;

  /// Makes a study on a thread of its own; no job and no other call waits for it. Its outcome is a JSON object: study,
  /// directory, report; or what StudyDesk::make() throws. Throws Error kBusy while another study is being made,
  /// kShuttingDown.
  virtual std::shared_ptr<DeviceTask> begin(StudyRequest request) = 0;

  /// Throws Error kStudyRefused where there is none of that id.
  [[nodiscard]] virtual Study get(const std::string& id) const = 0;
  /// Where its files are.
  [[nodiscard]] virtual std::filesystem::path folder_of(const std::string& id) const = 0;
  /// The newest first.
  [[nodiscard]] virtual std::vector<Study> list() const = 0;
  [[nodiscard]] virtual std::vector<BrokenStudy> broken() const = 0;

  /// As StudyDesk::accept(), today.
  virtual AcceptedConstants accept(const AcceptRequest& request) = 0;
  /// All versions, the oldest first.
  [[nodiscard]] virtual std::vector<Calibration> calibrations() const = 0;
};

/// All that the API is built on; each may be another object.
struct Services {
  MachineView& machine;
  JobService& jobs;
  ResultService& results;
  TaskService& tasks;
  RecipeService& recipes;
  ObjectiveService& objectives;
  StudyService& studies;
};

}  // namespace fvd
