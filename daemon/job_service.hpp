#pragma once

/// Jobs as the RPC sees them; the engine implements it, tests put a fake in its place.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/metrology/step_history.hpp"
#include "core/scan/frame_ledger.hpp"
#include "core/scan/scan_state.hpp"
#include "daemon/device_task.hpp"

namespace fvd {

struct JobRequest {
  std::int64_t seq = 0;  ///< the client's sequence number, 1..2^53-1; the same number is the same job
  std::string part_id;   ///< 1..64 printable ASCII characters
  std::string recipe;    ///< recipe id; empty = the prepared one
};

/// OPC 40100-1 result states: processing, completed, aborted, failed.
enum class JobState { kProcessing, kCompleted, kAborted, kFailed };
[[nodiscard]] std::string_view job_state_name(JobState state) noexcept;

struct JobStatus {
  std::string job_id;
  JobRequest request;
  JobState state = JobState::kProcessing;
  std::string phase;      ///< "preparing", "acquiring", "computing", "storing", "" when ended
  bool acquired = false;  ///< the part may be moved
  int slices_done = 0;
  int slices_planned = 0;
  FrameCounts frames;
  std::optional<ErrorCode> error;  ///< why it failed or was aborted
  std::string error_message;
  bool acknowledged = false;  ///< result.ack was received
};

/// A job by id or by sequence number.
using JobKey = std::variant<std::string, std::int64_t>;

struct MachineStatus {
  ScanState state = ScanState::kPreoperational;
  std::string recipe;            ///< prepared recipe, empty = none
  std::optional<JobStatus> job;  ///< the running or the latest job
  int results_waiting = 0;       ///< completed and not acknowledged
  bool simulated = false;
  std::int64_t epoch = 0;          ///< counts the daemon's starts
  std::optional<ErrorCode> error;  ///< why the state is kError
  std::string error_message;
};

/// context: every function thread-safe; none blocks longer than a database commit.
class JobService {
 public:
  virtual ~JobService() = default;

  struct Started {
    JobStatus job;
    bool duplicate = false;
  };
  /// Accepts a job and returns after its row is durable; the scan runs later on the engine's thread. A repeated request
  /// returns the existing job. Throws Error kNotReady, kBusy, kUnknownRecipe, kBadRecipe, kStageLimit, kMemoryBudget,
  /// kSeqConflict, kSeqStale, kStorageFull, kDatabase, kShuttingDown.
  virtual Started start(const JobRequest& request) = 0;

  /// Throws Error kUnknownJob.
  [[nodiscard]] virtual JobStatus job(const JobKey& key) const = 0;

  /// Asks the job to end; returns at once with its status. No effect on a job that has ended. Throws Error kUnknownJob.
  virtual JobStatus abort(const JobKey& key) = 0;

  /// The JSON text of the job's result.json; empty while there is none. Throws Error kUnknownJob.
  [[nodiscard]] virtual std::string result_json(const JobKey& key) const = 0;
  /// The job's result directory; empty while there is none. Throws Error kUnknownJob.
  [[nodiscard]] virtual std::string result_dir(const JobKey& key) const = 0;

  /// The oldest ended job that was not acknowledged.
  [[nodiscard]] virtual std::optional<JobStatus> next_unacknowledged() const = 0;

  /// Returns how many remain. Repeating it changes nothing. Throws Error kUnknownJob, kBusy while the job runs.
  virtual int acknowledge(const JobKey& key) = 0;

  /// Loads and checks a recipe and makes it the prepared one. Throws Error kUnknownRecipe, kBadRecipe, kStageLimit,
  /// kBusy.
  virtual void prepare(const std::string& recipe_id) = 0;

  [[nodiscard]] virtual std::vector<std::string> recipe_ids() const = 0;
  /// The recipe file's JSON text. Throws Error kUnknownRecipe.
  [[nodiscard]] virtual std::string recipe_json(const std::string& recipe_id) const = 0;

  [[nodiscard]] virtual MachineStatus machine() const = 0;

  /// What all scans so far say of the stage; nothing before the first.
  [[nodiscard]] virtual std::optional<StepHistorySummary> stage_history() const = 0;

  /// Has the engine do something with the devices as soon as it can; a job that is started meanwhile ends it. Throws
  /// Error kBusy while a job runs or another task waits, kNotReady without the devices, kShuttingDown.
  virtual std::shared_ptr<DeviceTask> submit(DeviceTask::Work work) = 0;
  /// As submit(preview_work(settings)); while a job runs, the newest of its slices instead, scaled down.
  virtual std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) = 0;

  /// Called after every change of a job or the machine, from the engine's threads; must return at once. Set before use.
  virtual void on_change(std::function<void()> listener) = 0;
};

}  // namespace fvd
