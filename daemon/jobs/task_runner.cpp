#include "daemon/jobs/task_runner.hpp"

#include "core/base/error.hpp"
#include "daemon/jobs/device_commands.hpp"
#include "daemon/jobs/objective_limits.hpp"

namespace fvd {

std::shared_ptr<DeviceTask> TaskRunner::submit(DeviceTask::Work work, TaskMotion motion, HostTime asked) {
  auto task = std::make_shared<DeviceTask>(std::move(work), motion);
  post(task, asked);
  return task;
}

void TaskRunner::post(const std::shared_ptr<DeviceTask>& task, HostTime asked) {
  const std::stop_source stop;
  bool posted = false;
  // In one piece: a job that is accepted later finds the command's stop in place and is behind it in the queue.
  deps_.board.update([&](MachineRecord& machine) {
    machine.require(Command::kRunTask);
    if (task->moves()) deps_.board.require_unstopped(asked);
    machine.apply(task->moves() ? MachineEvent::kMotionStarted : MachineEvent::kLookStarted);
    {
      const MutexLock lock(mutex_);
      stop_ = stop;
    }
    posted = deps_.work.post({.run = [this, task, token = stop.get_token()] { run(*task, token); },
                              .refuse = [this, task] { refuse(*task); }});
  });
  if (!posted) refuse(*task);
}

std::shared_ptr<DeviceTask> TaskRunner::preview(const CameraSettings& settings) {
  const auto now = deps_.board.snapshot();
  if (!now->job || now->job->state != JobState::kProcessing)
    return submit(preview_work(settings), TaskMotion::kNone, {});
  auto picture = deps_.preview.newest();
  if (!picture) throw Error(ErrorCode::kBusy, "the job has shown no slice yet; ask again");
  return std::make_shared<DeviceTask>(DeviceTask::Outcome{std::move(*picture), std::nullopt, {}});
}

std::shared_ptr<const PreviewPicture> TaskRunner::newest_picture() { return deps_.preview.newest_picture(); }

std::shared_ptr<JogHold> TaskRunner::last_jog() {
  const MutexLock lock(mutex_);
  return jog_;
}

bool TaskRunner::extend_jog(const JogRequest& request) {
  const auto running = last_jog();
  return running && running->extend(request);
}

void TaskRunner::jog(const JogRequest& request) {
  if (const auto before = last_jog()) {
    if (const auto failure = before->take_failure(request)) throw *failure;
  }
  if (HostClock::now() >= request.until) {
    throw Error(ErrorCode::kTimeout, "the request waited for longer than it asked to move; nothing was moved");
  }
  auto hold = std::make_shared<JogHold>(request);
  post(jog_task(hold), request.asked);
  const MutexLock lock(mutex_);
  jog_ = std::move(hold);
}

std::optional<StepHistorySummary> TaskRunner::stage_history() const { return deps_.history.summary(); }

std::stop_source TaskRunner::task_stop() {
  const MutexLock lock(mutex_);
  return stop_;
}

void TaskRunner::run(DeviceTask& task, const std::stop_token& stop) {
  DeviceTask::Outcome outcome;
  std::optional<DeviceFailure> failure;
  const bool begins = !stop.stop_requested();
  if (!begins) {
    const bool halted = deps_.board.read().state.halted;
    outcome = {{},
               halted ? ErrorCode::kShuttingDown : ErrorCode::kAborted,
               "a job was started, or the daemon was shut down, before the command could begin"};
  } else if ((failure = deps_.hub.open())) {
    outcome = {{}, ErrorCode::kNotReady, failure->message};
  } else {
    outcome = performed(task, stop);
    if (!outcome.error && task.moves()) deps_.hub.confirm_rest();
    failure = outcome.error ? deps_.hub.after_failure(*outcome.error, outcome.message) : deps_.hub.failure();
  }
  const std::optional<DeviceFailure> alarm = deps_.hub.alarm();
  task.foretell(outcome);  // a repeated jog finds why it ended before it could begin anew
  deps_.board.update([&](MachineRecord& machine) {
    machine.apply(MachineEvent::kTaskEnded);
    if (begins) {
      machine.set_devices(failure);
      machine.set_alarm(alarm);
    }
  });
  task.end(std::move(outcome));               // whoever reads it finds the devices free
  deps_.board.update([](MachineRecord&) {});  // its caller is told
}

DeviceTask::Outcome TaskRunner::performed(const DeviceTask& task, const std::stop_token& stop) const {
  // Gone before the camera may be given up: its end waits for a call that is under way.
  const std::stop_callback wake(stop, [this] { deps_.hub.camera().interrupt(); });
  const ObjectiveConfig* objective = find_objective(deps_.objectives, deps_.board.read().objective);
  return task.perform({deps_.hub.camera(), deps_.hub.axis(), deps_.clock, deps_.state_dir, objective, &deps_.preview},
                      stop);
}

void TaskRunner::refuse(DeviceTask& task) {
  deps_.board.update([](MachineRecord& machine) { machine.apply(MachineEvent::kTaskEnded); });
  task.fail(ErrorCode::kShuttingDown, "the daemon was shut down before this could begin; ask again when it is back");
  deps_.board.update([](MachineRecord&) {});  // its caller is told
}

}  // namespace fvd
