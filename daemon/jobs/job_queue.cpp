#include "daemon/jobs/job_queue.hpp"

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/jobs/objective_book.hpp"
#include "daemon/jobs/objective_limits.hpp"
#include "daemon/pipeline/job_storage.hpp"

namespace fvd {

/// Holds a client's sequence number while its request is answered. A repetition waits here, and then finds the first
/// one's row.
class JobQueue::Claim {
 public:
  Claim(JobQueue& queue, const JobRequest& request) : queue_(queue), key_(key_of(request)) {
    MutexLock lock(queue_.mutex_);
    queue_.claim_ended_.wait(lock, [this] {
      queue_.mutex_.assert_held();
      return queue_.claimed_.count(key_) == 0;
    });
    queue_.claimed_.insert(key_);
  }
  ~Claim() {
    {
      const MutexLock lock(queue_.mutex_);
      queue_.claimed_.erase(key_);
    }
    queue_.claim_ended_.notify_all();
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  JobQueue& queue_;
  RequestKey key_;
};

JobService::Started JobQueue::start(const JobRequest& request) {
  const Claim claim(*this, request);
  if (auto known = deps_.store.find_repeated(request)) {
    if (known->error == ErrorCode::kInterrupted) {
      throw Error(ErrorCode::kInterrupted, "job " + known->job_id + " of this number was interrupted, and has no " +
                                               "result: measure the part again with a new sequence number");
    }
    // The running job is known better on the board than in the database.
    return {on_board(known->job_id).value_or(*known), true};
  }
  deps_.runner.look_after_storage();  // as it is now, not as it was half a second ago
  const Offer offered = offer(request);
  AcceptedJob job;
  try {
    job = made_durable(request, offered);
  } catch (...) {
    deps_.board.update([](MachineRecord& machine) { machine.apply(MachineEvent::kJobRefused); });
    throw;
  }
  accept(job, offered);
  return {job.status, false};
}

JobQueue::Offer JobQueue::offer(const JobRequest& request) {
  Offer offer;
  const HostTime stopped = deps_.board.last_stop();
  deps_.board.update([&](MachineRecord& machine) {
    machine.require(Command::kStartJob);
    deps_.board.require_unstopped(request.asked);
    machine.apply(MachineEvent::kJobOffered);
    offer = {request.recipe.empty() ? machine.recipe : request.recipe, machine.devices, machine.objective, stopped};
  });
  return offer;
}

AcceptedJob JobQueue::made_durable(const JobRequest& request, const Offer& offer) {
  AcceptedJob job;
  job.recipe = checked_recipe(offer);
  const CameraSettings& camera = job.recipe.camera;
  deps_.storage.require_room(
      job_storage_bytes(job.recipe, camera.width > 0 ? camera.width : offer.devices->camera.sensor_width,
                        camera.height > 0 ? camera.height : offer.devices->camera.sensor_height),
      "recipe " + job.recipe.id);
  JobRequest resolved = request;
  resolved.recipe = job.recipe.id;
  job.status = deps_.store.accept(resolved);
  job.status.slices_planned = job.recipe.slices * job.recipe.repeat;
  job.status.phase = "preparing";
  return job;
}

void JobQueue::accept(const AcceptedJob& job, const Offer& offer) {
  std::stop_source stop;
  std::stop_source task_stop{std::nostopstate};
  bool posted = false;
  deps_.board.update([&](MachineRecord& machine) {
    machine.apply(MachineEvent::kJobAccepted);
    machine.recipe = job.recipe.id;
    machine.job = job.status;
    // stop_job() or stop_motion() was called before it could reach this job
    if (machine.state.halted || deps_.board.last_stop() != offer.stopped) stop.request_stop();
    task_stop = deps_.task_stop();
    {
      const MutexLock lock(mutex_);
      stoppable_ = job.status.job_id;
      stop_ = stop;
    }
    posted = deps_.work.post({.run = [this, job, token = stop.get_token()] { deps_.runner.run(job, token); },
                              .refuse = [this, job] { deps_.runner.refuse(job); }});
  });
  task_stop.request_stop();  // measuring comes first
  if (!posted) deps_.runner.refuse(job);
}

Recipe JobQueue::checked_recipe(const Offer& offer) const {
  if (offer.recipe_id.empty()) {
    throw Error(ErrorCode::kUnknownRecipe, "no recipe is named and none is prepared: name one or call recipe.prepare");
  }
  Recipe recipe = deps_.load_recipe(offer.recipe_id);
  require_objective(recipe.objective, offer.objective, deps_.objectives);
  require_acceptable(recipe, offer.devices, find_objective(deps_.objectives, offer.objective), deps_.limits);
  return recipe;
}

std::optional<JobStatus> JobQueue::on_board(const JobKey& key) const {
  auto job = deps_.board.snapshot()->job;
  return job && names(key, *job) ? job : std::nullopt;
}

JobStatus JobQueue::job(const JobKey& key) const {
  if (const auto job = on_board(key)) return *job;
  return deps_.store.find(key).status;
}

std::optional<JobStatus> JobQueue::highest(const std::string& client) const { return deps_.store.highest(client); }

JobStatus JobQueue::abort(const JobKey& key) {
  const auto job = try_abort(key);
  return job ? *job : deps_.store.find(key).status;
}

std::optional<JobStatus> JobQueue::try_abort(const JobKey& key) {
  auto job = on_board(key);
  if (!job) return std::nullopt;
  std::optional<std::stop_source> stop;
  {
    const MutexLock lock(mutex_);
    if (stoppable_ == job->job_id) stop = stop_;
  }
  if (stop && job->state == JobState::kProcessing) stop->request_stop();
  return job;
}

JobService::Stopped JobQueue::stop_motion() {
  deps_.board.note_stop();  // first: what begins from now on sees it, what began before is on the board
  const MachineState now = deps_.board.read().state;
  if (now.task == TaskState::kMoves) deps_.task_stop().request_stop();
  if (now.job == JobStage::kHoldsPart) stop_job();
  // Wakes the machine's thread, which looks after a stage that moves although nobody uses it.
  (void)deps_.work.post({.run = [] {}, .refuse = [] {}});
  if (now.job == JobStage::kHoldsPart) return Stopped::kJob;
  return now.task == TaskState::kMoves ? Stopped::kCommand : Stopped::kNothing;
}

void JobQueue::stop_job() {
  std::stop_source stop{std::nostopstate};
  {
    const MutexLock lock(mutex_);
    stop = stop_;
  }
  stop.request_stop();  // not under the lock: it calls what waits for it
}

void JobQueue::prepare(const std::string& recipe_id) {
  const MachineRecord now = deps_.board.read();
  now.require(Command::kPrepareRecipe);
  const Recipe recipe = checked_recipe({recipe_id, now.devices, now.objective});
  deps_.store.remember_prepared(recipe.id);
  deps_.board.update([&](MachineRecord& machine) {
    machine.require(Command::kPrepareRecipe);
    machine.recipe = recipe.id;
    machine.apply(MachineEvent::kRecipePrepared);
  });
}

void JobQueue::restore_prepared() {
  if (restored_) return;
  const MachineRecord now = deps_.board.read();
  if (now.state.devices != DevicesState::kUp) return;
  restored_ = true;
  if (now.recipe.empty() || now.state.prepared) return;
  try {
    prepare(now.recipe);
  } catch (const Error& failure) {
    spdlog::warn("recipe {}, which was prepared when the daemon ended, is not prepared again: {}", now.recipe,
                 failure.what());
    deps_.board.update([&now](MachineRecord& machine) {
      if (!machine.state.prepared && machine.recipe == now.recipe) machine.recipe.clear();
    });
  }
}

std::optional<StoredJob> JobQueue::stored_evaluation(const JobKey& key) const {
  const auto* id = std::get_if<std::string>(&key);
  if (id == nullptr) return std::nullopt;
  const auto evaluation = deps_.store.evaluations().find(*id);
  if (!evaluation) return std::nullopt;
  StoredJob told = deps_.store.find(evaluation->job_id);
  told.status.job_id = evaluation->id;
  told.status.request.recipe = evaluation->recipe;
  told.result_dir = evaluation->result_dir;
  told.result_json = evaluation->result_json;
  return told;
}

StoredJob JobQueue::stored(const JobKey& key) const {
  if (auto evaluation = stored_evaluation(key)) return *std::move(evaluation);
  StoredJob stored = deps_.store.find(key);
  if (stored.status.state != JobState::kProcessing) return stored;
  const auto running = on_board(key);
  if (!running) return stored;
  if (running->state != JobState::kProcessing) return deps_.store.find(key);  // it has ended in between
  stored.status = *running;
  return stored;
}

std::optional<JobStatus> JobQueue::next_unacknowledged() const { return deps_.store.next_unacknowledged(); }

std::shared_ptr<DeviceTask> JobQueue::evaluate(const JobKey& key, const std::string& recipe_id) {
  if (const auto evaluation = stored_evaluation(key)) {
    throw Error(ErrorCode::kBadInput,
                evaluation->status.job_id + " is an evaluation itself: name the job whose surface is meant");
  }
  return deps_.evaluator.begin(stored(key), deps_.load_recipe(recipe_id));
}

int JobQueue::acknowledge(const JobKey& key) {
  const int remaining = deps_.store.acknowledge(key);
  deps_.board.update([&](MachineRecord& machine) {
    if (!machine.job || !names(key, *machine.job)) return;
    machine.job->acknowledged = true;
    machine.job->not_durable.clear();
  });
  return remaining;
}

}  // namespace fvd
