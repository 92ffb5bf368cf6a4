#pragma once

/// The parts that measure, wired: one machine, its devices, its thread, its jobs and commands.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/clock.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/calibration/calibration_book.hpp"
#include "daemon/config/config.hpp"
#include "daemon/devices/device_hub.hpp"
#include "daemon/export/preview_hub.hpp"
#include "daemon/jobs/alarm_log.hpp"
#include "daemon/jobs/audit_log.hpp"
#include "daemon/jobs/control_lease.hpp"
#include "daemon/jobs/following_files.hpp"
#include "daemon/jobs/job_queue.hpp"
#include "daemon/jobs/job_runner.hpp"
#include "daemon/jobs/machine_board.hpp"
#include "daemon/jobs/machine_thread.hpp"
#include "daemon/jobs/objective_book.hpp"
#include "daemon/jobs/result_evaluator.hpp"
#include "daemon/jobs/retention.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/jobs/study_runner.hpp"
#include "daemon/jobs/task_runner.hpp"
#include "daemon/jobs/work_queue.hpp"
#include "daemon/recipes/recipe_book.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/store/stage_history.hpp"
#include "daemon/store/storage_watch.hpp"

namespace fvd {

struct EngineDependencies {
  JobStore& store;
  Clock& clock;
  DeviceOpeners openers;
  ResultPipeline make_result = store_result;
  RepeatabilityOf repeatability = {};     ///< of the recipes' values; empty = as its own gauge studies found it
  std::shared_ptr<AlarmLog> alarms = {};  ///< that the log's lines come to; null = none do
};

/// context: made and destroyed on one thread; the services are thread-safe.
class Engine {
 public:
  /// Warns of the latest job if a restart interrupted it and nobody acknowledged that yet. Throws Error
  /// kBadInput where the constants of the instrument cannot be read.
  Engine(const Config& config, const EngineDependencies& dependencies);
  /// finish().
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Opens the devices, and takes jobs and commands once they are open; until then the machine is preoperational. To be
  /// called once.
  void start() {
    following_.start();
    retention_.start();
    thread_.start();
  }

  [[nodiscard]] Services services() {
    return {board_,   jobs_,  jobs_,   tasks_,    recipes_, objectives_, study_runner_,
            control_, audit_, access_, refusals_, jobs_,    *alarms_};
  }

  /// For who looks on. context: any thread.
  [[nodiscard]] PictureSource& pictures() { return tasks_; }

  /// What a reload changes while all goes on. context: any thread.
  void take(const StoreConfig& limits) { retention_.set_limits(limits); }

  /// A row of the audit: a configuration was read. what: why, and what it changed. context: any thread.
  void note_configuration(const Config& in_force, const std::string& what, std::string_view outcome = "ok");

  /// The instrument's constants, in <state_dir>/calibration. context: any thread.
  [[nodiscard]] CalibrationBook& calibrations() { return calibrations_; }

  /// Takes no more jobs and commands from now on, and asks what runs to end; returns at once. context: any thread.
  void shut_down();
  /// shut_down(), then waits until all has ended and the devices were given up. A job that ran ends as aborted, one
  /// that had not begun as failed, and a command that had not begun is answered as failed, each with kShuttingDown.
  void finish();

 private:
  /// What can be told between jobs. context: the machine's thread.
  void note_health();

  const std::filesystem::path state_dir_;
  const std::shared_ptr<AlarmLog> alarms_;
  WorkerPool pool_;
  KeptPagesPtr pages_;
  StageHistory history_;
  CalibrationBook calibrations_;
  StudyBook studies_;
  RecipeBook recipes_;
  PreviewHub preview_;
  MachineBoard board_;
  AccessRules access_;
  RefusedCalls refusals_;
  ControlLease control_;
  AuditLog audit_;
  ObjectiveBook objectives_;
  DeviceHub hub_;
  WorkQueue work_;
  ThreadTicks ticks_;  // of thread_
  TaskRunner tasks_;
  StorageWatch storage_;
  FollowingFiles following_;
  Retention retention_;
  JobRunner runner_;
  ResultEvaluator evaluator_;
  JobQueue jobs_;
  StudyDesk desk_;
  StudyRunner study_runner_;
  MachineThread thread_;  // last: ends before anything it uses
};

}  // namespace fvd
