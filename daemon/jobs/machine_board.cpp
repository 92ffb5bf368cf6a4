#include "daemon/jobs/machine_board.hpp"

#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/base/systemd_notify.hpp"

namespace fvd {

void MachineRecord::apply(MachineEvent event) { state = after(state, event).value_or(state); }

void MachineRecord::set_devices(const std::optional<DeviceFailure>& why_not) {
  apply(why_not ? MachineEvent::kDevicesDown : MachineEvent::kDevicesUp);
  failure = why_not;
}

void MachineRecord::set_alarm(const std::optional<DeviceFailure>& seen) {
  apply(seen ? MachineEvent::kAlarmSeen : MachineEvent::kAlarmGone);
  alarm = seen;
}

void MachineRecord::set_storage(const std::optional<StorageProblem>& why_not) {
  apply(why_not ? MachineEvent::kStorageBad : MachineEvent::kStorageGood);
  storage = why_not;
}

void MachineRecord::require_objective_unused() const {
  if (state.halted) throw Error(ErrorCode::kShuttingDown, "the daemon is shutting down");
  if (state.job != JobStage::kNone) {
    throw Error(ErrorCode::kBusy, "a job is accepted or runs with the objective '" + objective +
                                      "': confirm another when the job has ended");
  }
  if (state.task != TaskState::kNone || confirming) {
    throw Error(ErrorCode::kBusy, "the devices are busy with another command; try again when it is done");
  }
}

void MachineRecord::require(Command command) const {
  if (confirming) throw Error(ErrorCode::kBusy, "an objective is being confirmed; try again when it is done");
  switch (refusal(state, command)) {
    case Refusal::kNone:
      return;
    case Refusal::kShuttingDown:
      throw Error(ErrorCode::kShuttingDown, "the daemon is shutting down and takes no more jobs");
    case Refusal::kJobRuns:
      throw Error(ErrorCode::kBusy, "job " + (job ? job->job_id : "") + " is running; wait for it to end");
    case Refusal::kJobOffered:
      throw Error(ErrorCode::kBusy, "another job is being accepted; wait for it to end");
    case Refusal::kTaskRuns:
      throw Error(ErrorCode::kBusy, "the devices are busy with another command; try again when it is done");
    case Refusal::kOpening:
      throw Error(ErrorCode::kNotReady, "the devices are still being opened");
    case Refusal::kStorage:
      throw storage ? Error(storage->code, storage->message)
                    : Error(ErrorCode::kStorageWrite, "results cannot be kept");
    case Refusal::kDeviceMissing:
      throw Error(ErrorCode::kNotReady, failure ? failure->message : "a device is missing");
    case Refusal::kAlarm:
      throw Error(ErrorCode::kNotReady, alarm ? alarm->message : "the drive has an alarm");
  }
}

namespace {

/// A job has ended by this change of the record.
bool is_end(const std::optional<JobStatus>& before, const std::optional<JobStatus>& after) {
  if (!after || after->state == JobState::kProcessing) return false;
  return !before || before->job_id != after->job_id || before->state == JobState::kProcessing;
}

void count_end(JobState how, JobCounts& ended) {
  switch (how) {
    case JobState::kCompleted:
      ++ended.completed;
      break;
    case JobState::kAborted:
      ++ended.aborted;
      break;
    default:
      ++ended.failed;
      break;
  }
}

}  // namespace

MachineBoard::MachineBoard(Constants constants, std::optional<JobStatus> latest_job)
    : constants_(std::move(constants)) {
  const MutexLock lock(mutex_);
  ended_.interrupted = constants_.jobs_interrupted;
  record_.job = std::move(latest_job);
  if (record_.job && record_.job->state == JobState::kCompleted) completed_job_ = record_.job->job_id;
  publish_locked();
}

std::shared_ptr<const MachineStatus> MachineBoard::snapshot() const {
  const MutexLock lock(status_mutex_);
  return status_;
}

bool MachineBoard::stage_stands() const {
  return snapshot()->signals.part_release && (!constants_.axis_stands || constants_.axis_stands());
}

void MachineBoard::on_change(std::function<void()> listener, const void* whose) {
  const MutexLock lock(telling_mutex_);
  if (listener) {
    listeners_[whose] = std::move(listener);
  } else {
    listeners_.erase(whose);
  }
}

MachineRecord MachineBoard::read() const {
  const MutexLock lock(mutex_);
  return record_;
}

void MachineBoard::update(const std::function<void(MachineRecord&)>& change) {
  {
    const MutexLock lock(mutex_);
    MachineRecord next = record_;
    change(next);
    const ScanState before = scan_state(record_.state);
    const bool was_free = signals(record_.state).part_release;
    if (is_end(record_.job, next.job)) {
      count_end(next.job->state, ended_);
      if (next.job->state == JobState::kCompleted) completed_job_ = next.job->job_id;
    }
    record_ = std::move(next);
    publish_locked();
    const ScanState now = scan_state(record_.state);
    const bool is_free = signals(record_.state).part_release;
    if (now != before) {
      untold_.push_back("state " + std::string(scan_state_name(before)) + " -> " + std::string(scan_state_name(now)));
    }
    if (is_free != was_free) untold_.push_back(std::string("part_release ") + (is_free ? "true" : "false"));
  }
  tell();
}

void MachineBoard::require_unstopped(HostTime asked) const {
  if (asked == HostTime{} || last_stop() <= asked) return;
  throw Error(ErrorCode::kAborted, "this was asked for before a stop, and had not begun: nothing was moved");
}

void MachineBoard::publish_locked() {
  auto status = std::make_shared<MachineStatus>();
  status->state = scan_state(record_.state);
  status->signals = signals(record_.state);
  status->recipe = record_.recipe;
  status->objective = record_.objective;
  status->job = record_.job;
  status->results_waiting = constants_.results_waiting();
  status->result_valid = constants_.results_valid && constants_.results_valid() > 0;
  status->overrun = status->results_waiting > constants_.fifo_results;
  if (constants_.newest_seqs) status->newest_seqs = constants_.newest_seqs();
  status->simulated = constants_.simulated || (record_.devices && record_.devices->simulated);
  if (record_.devices) status->camera = record_.devices->camera;
  status->epoch = constants_.epoch;
  status->ended = ended_;
  status->completed_job = completed_job_;
  status->health = record_.health;
  status->disk = record_.disk;
  if (record_.failure) {
    status->error = record_.failure->code;
    status->error_message = record_.failure->message;
  } else if (record_.alarm) {
    status->error = record_.alarm->code;
    status->error_message = record_.alarm->message;
  } else if (record_.storage) {
    status->error = record_.storage->code;
    status->error_message = record_.storage->message;
  }
  const MutexLock lock(status_mutex_);
  status_ = std::move(status);
}

void MachineBoard::tell() {
  const MutexLock telling(telling_mutex_);  // the log has the changes in their order
  std::vector<std::string> news;
  std::string state;
  {
    const MutexLock lock(mutex_);
    news = std::exchange(untold_, {});
    state = scan_state_name(scan_state(record_.state));
  }
  for (const std::string& change : news) spdlog::info("{}", change);
  if (!news.empty()) notify_status(state);
  for (const auto& [whose, listener] : listeners_) listener();
}

}  // namespace fvd
