#pragma once

/// One job from its start to its durable end.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "core/base/clock.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/calibration/calibration_book.hpp"
#include "daemon/config/config.hpp"
#include "daemon/devices/device_hub.hpp"
#include "daemon/export/preview_hub.hpp"
#include "daemon/jobs/following_files.hpp"
#include "daemon/jobs/job_constants.hpp"
#include "daemon/jobs/machine_board.hpp"
#include "daemon/jobs/result_pipeline.hpp"
#include "daemon/pipeline/measurement.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/store/stage_history.hpp"
#include "daemon/store/storage_watch.hpp"

namespace fvd {

struct AcceptedJob {
  JobStatus status;
  Recipe recipe;
};

/// context: run() on the machine's thread, the others on any.
class JobRunner {
 public:
  struct Dependencies {
    const Config& config;
    JobStore& store;
    MachineBoard& board;
    DeviceHub& hub;
    Clock& clock;
    WorkerPool& pool;
    KeptPagesPtr pages;
    PreviewHub& preview;
    StageHistory& history;
    ThreadTicks& ticks;  ///< of the machine's thread
    const CalibrationBook& calibrations;
    FollowingFiles& following;
    const StorageWatch& storage;
    ResultPipeline make_result = store_result;
    RepeatabilityOf repeatability = {};  ///< empty = nobody keeps gauge studies
  };
  explicit JobRunner(Dependencies dependencies) : deps_(std::move(dependencies)) {}

  /// Measures, and ends the job however that goes: its row first, then the board, then the devices are looked after.
  /// An end that the database cannot take is told with JobStatus::not_durable. Never throws.
  void run(const AcceptedJob& job, const std::stop_token& stop);

  /// Ends a job that did not begin because the daemon goes: failed, kShuttingDown. Never throws.
  void refuse(const AcceptedJob& job);

  /// store_late_end(), and then tells the board whether results can be kept. Never throws.
  void look_after_storage();

  /// Tries again to store the end of the latest job, if the database could not take it when it came. Never throws.
  void store_late_end();

 private:
  /// How a job ended.
  struct JobEnd {
    JobState state = JobState::kFailed;
    std::optional<ErrorCode> error = std::nullopt;
    std::string message = {};
    JobResult result = {};                                ///< empty directory = none
    bool used_devices = true;                             ///< and knows how they are:
    std::optional<DeviceFailure> failure = std::nullopt;  ///< why they cannot be used after it
  };

  [[nodiscard]] JobEnd measured(const AcceptedJob& job, const std::stop_token& stop);
  /// Waits until the job fits into the memory beside the files of results before it.
  void wait_for_memory(const AcceptedJob& job, const std::stop_token& stop);
  [[nodiscard]] JobResult acquire_and_store(const AcceptedJob& job, const std::stop_token& stop);
  [[nodiscard]] JobEnd failed(ErrorCode code, const std::string& message);
  [[nodiscard]] MeasurementObserver observer();
  [[nodiscard]] bool halted() const { return deps_.board.read().state.halted; }
  void end(const AcceptedJob& job, const JobEnd& end);

  Dependencies deps_;
  std::chrono::milliseconds longest_step_{};  ///< of the job that runs
};

}  // namespace fvd
