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
#include "daemon/access/access_rules.hpp"
#include "daemon/access/refused_calls.hpp"
#include "daemon/config/config.hpp"
#include "daemon/devices/devices_health.hpp"
#include "daemon/jobs/alarm.hpp"
#include "daemon/jobs/control_lease.hpp"
#include "daemon/jobs/device_task.hpp"
#include "daemon/jobs/jog.hpp"
#include "daemon/jobs/machine_state.hpp"
#include "daemon/recipes/recipe_service.hpp"
#include "daemon/store/audit_table.hpp"
#include "daemon/store/job_history.hpp"
#include "daemon/store/job_status.hpp"
#include "daemon/store/objective_table.hpp"
#include "daemon/store/sequence_numbers.hpp"
#include "daemon/study/study_desk.hpp"

namespace fvd {

struct PreviewPicture;

/// Jobs that ended since the daemon's start.
struct JobCounts {
  std::uint64_t completed = 0;
  std::uint64_t aborted = 0;
  std::uint64_t failed = 0;
  std::uint64_t interrupted = 0;  ///< of all starts: they ran when a daemon ended, and have no result
};

/// Of the file system that holds database and results.
struct DiskSpace {
  std::uint64_t free_bytes = 0;  ///< for the service
  std::uint64_t size_bytes = 0;
};

struct MachineStatus {
  ScanState state = ScanState::kPreoperational;
  std::string recipe;            ///< prepared recipe, empty = none
  std::string objective;         ///< confirmed objective, empty = none
  std::optional<JobStatus> job;  ///< the running or the latest job
  Signals signals;
  int results_waiting = 0;                        ///< ended jobs that are not acknowledged
  bool result_valid = false;                      ///< one of them is completed
  bool overrun = false;                           ///< more wait than the controller should ever leave
  std::shared_ptr<const NewestSeqs> newest_seqs;  ///< of each client; null = nobody says
  bool simulated = false;
  std::int64_t epoch = 0;          ///< counts the daemon's starts
  std::optional<ErrorCode> error;  ///< why the state is kError: a device, or where results are kept
  std::string error_message;
  std::optional<CameraInfo> camera;  ///< that is open
  JobCounts ended;
  std::string completed_job;      ///< whose result is the newest, whatever has begun since; empty = none is known
  DevicesHealth health;           ///< as it was between jobs and commands, half a second ago at most if none runs
  std::optional<DiskSpace> disk;  ///< likewise; nothing if it cannot be told
};

/// What readers poll: made anew at every change, never waited for.
class MachineView {
 public:
  virtual ~MachineView() = default;
  /// No lock that is held across a database or file access; never null.
  [[nodiscard]] virtual std::shared_ptr<const MachineStatus> snapshot() const = 0;
  /// True if the snapshot says part_release and the stage's newest sample bears it out: the snapshot alone is as old as
  /// the last look at the devices, which is minutes while a job is evaluated. Asks nothing of the devices, waits for
  /// none. context: any thread.
  [[nodiscard]] virtual bool stage_stands() const = 0;
  /// Called after every change of a job or the machine, from any thread; must return at once. One for each `whose`; an
  /// empty one ends it: after the return it is not called again.
  virtual void on_change(std::function<void()> listener, const void* whose = nullptr) = 0;
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
  /// kMemoryBudget, kSeqConflict, kSeqStale, kInterrupted, kStorageFull, kStorageWrite, kDatabase, kShuttingDown,
  /// kAborted if stop_motion() came after it was asked for.
  virtual Started start(const JobRequest& request) = 0;

  /// Throws Error kUnknownJob.
  [[nodiscard]] virtual JobStatus job(const JobKey& key) const = 0;

  /// The client's job with the highest sequence number.
  [[nodiscard]] virtual std::optional<JobStatus> highest(const std::string& client) const = 0;

  /// Asks the job to end; returns at once with its status. No effect on a job that has ended. Throws Error kUnknownJob.
  virtual JobStatus abort(const JobKey& key) = 0;
  /// The same for the running or the latest job; nothing, and no effect, for any other. Blocks for nothing.
  virtual std::optional<JobStatus> try_abort(const JobKey& key) = 0;

  /// What a stop ended.
  enum class Stopped { kNothing, kCommand, kJob };
  /// Ends whatever moves the stage, or is about to: a command, a job that still holds the part, one that is being
  /// accepted. What was asked for before it begins no motion after it. Blocks for nothing.
  virtual Stopped stop_motion() = 0;
  /// True if the last stop_motion() came after that time.
  [[nodiscard]] virtual bool stopped_since(HostTime time) const = 0;

  /// Loads and checks a recipe and makes it the prepared one. Throws Error kUnknownRecipe, kBadRecipe, kStageLimit,
  /// kObjectiveMismatch, kRegionOutside, kMemoryBudget, kBusy, kDatabase, kStorageFull. A restart does not change it.
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
  /// kUnknownJob, kResultRemoved, kUnknownRecipe, kBadRecipe, kBadInput, kMemoryBudget, kBusy, kShuttingDown.
  [[nodiscard]] virtual std::shared_ptr<DeviceTask> evaluate(const JobKey& key, const std::string& recipe_id) = 0;
};

/// Commands to the devices between the jobs.
/// context: every function thread-safe.
class TaskService {
 public:
  virtual ~TaskService() = default;

  /// Does something with the devices as soon as they are free; a job that is started meanwhile ends it. Throws
  /// Error kBusy while a job runs or another task waits, kNotReady without the devices, kShuttingDown, kAborted if it
  /// moves, was asked for at that time and stop_motion() came after it.
  virtual std::shared_ptr<DeviceTask> submit(DeviceTask::Work work, TaskMotion motion, HostTime asked = {}) = 0;
  /// As submit(preview_work(settings)); while a job runs, the newest of its slices instead, scaled down.
  virtual std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) = 0;

  /// Moves as long as it is repeated; returns when that begins, and what becomes of it is told to who repeats it.
  /// Throws what submit() does, and why the same jog ended just before.
  virtual void jog(const JogRequest& request) = 0;
  /// True if such a jog goes on until the request's time. Blocks for nothing.
  [[nodiscard]] virtual bool extend_jog(const JogRequest& request) = 0;

  /// What all scans so far say of the stage; nothing before the first.
  [[nodiscard]] virtual std::optional<StepHistorySummary> stage_history() const = 0;
};

/// Pictures of what the camera sees, for who looks on.
/// context: thread-safe; no device is asked and nothing is waited for.
class PictureSource {
 public:
  virtual ~PictureSource() = default;

  /// The newest slice of the job that runs, or the newest image that somebody took since the last one; null before the
  /// first. Whoever asks counts as a viewer for 3 s: without viewers a job keeps no slices for them.
  [[nodiscard]] virtual std::shared_ptr<const PreviewPicture> newest_picture() = 0;
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

/// Who asked for what. context: every function thread-safe.
class AuditService {
 public:
  virtual ~AuditService() = default;

  /// Of now. Blocks for nothing.
  virtual void note(AuditEntry entry) = 0;
  /// As AuditTable::newest().
  [[nodiscard]] virtual std::vector<AuditEntry> newest(int most, std::int64_t before) = 0;
};

/// Jobs and values in lists.
/// context: as JobService; a long list keeps nobody else waiting.
class HistoryService {
 public:
  virtual ~HistoryService() = default;

  /// As JobHistory::page().
  [[nodiscard]] virtual JobPage list(const JobFilter& filter, std::int64_t before, int most) const = 0;
  /// As JobHistory::values().
  [[nodiscard]] virtual ValueList values(const ValueQuery& query) const = 0;
};

/// What somebody has to see.
/// context: every function thread-safe; blocks for nothing.
class AlarmService {
 public:
  virtual ~AlarmService() = default;

  /// All that are kept, the newest first.
  [[nodiscard]] virtual std::vector<Alarm> newest() const = 0;
  /// Somebody has seen this one. Repeating it changes nothing. time_utc: its Alarm::time_utc, for numbers begin anew
  /// with each start; empty = whichever has the number. Throws Error kBadInput where there is none of that number any
  /// more, or it is of another time.
  virtual void acknowledge(std::int64_t number, std::string_view time_utc) = 0;
  /// Counts the changes of what newest() tells.
  [[nodiscard]] virtual std::uint64_t revision() const noexcept = 0;
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
  ControlLease& control;
  AuditService& audit;
  const AccessRules& access;
  RefusedCalls& refusals;  ///< of all ways in: the log's limit is one
  HistoryService& history;
  AlarmService& alarms;
};

}  // namespace fvd
