#pragma once

/// Accepts jobs, one at a time, and tells of them and their results.

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/jobs/job_check.hpp"
#include "daemon/jobs/job_runner.hpp"
#include "daemon/jobs/machine_board.hpp"
#include "daemon/jobs/result_evaluator.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/jobs/work_queue.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/store/storage_watch.hpp"

namespace fvd {

/// A job is offered (the machine takes no other), made durable, accepted (readers see it) and posted. Files and the
/// database are read and written between these steps, with no lock held.
/// context: thread-safe.
class JobQueue final : public JobService, public ResultService, public HistoryService {
 public:
  struct Dependencies {
    JobStore& store;
    MachineBoard& board;
    WorkQueue& work;
    JobRunner& runner;
    ResultEvaluator& evaluator;
    ComputeLimits limits;
    std::function<Recipe(const std::string& recipe_id)> load_recipe;  ///< throws as load_recipe() does
    std::function<std::stop_source()> task_stop;                      ///< as TaskRunner::task_stop()
    const std::vector<ObjectiveConfig>& objectives;                   ///< of the configuration
    const StorageWatch& storage;
  };
  explicit JobQueue(Dependencies dependencies) : deps_(std::move(dependencies)) {}

  Started start(const JobRequest& request) override;
  [[nodiscard]] JobStatus job(const JobKey& key) const override;
  [[nodiscard]] std::optional<JobStatus> highest(const std::string& client) const override;
  JobStatus abort(const JobKey& key) override;
  std::optional<JobStatus> try_abort(const JobKey& key) override;
  Stopped stop_motion() override;
  [[nodiscard]] bool stopped_since(HostTime time) const override { return deps_.board.last_stop() > time; }
  void prepare(const std::string& recipe_id) override;

  [[nodiscard]] StoredJob stored(const JobKey& key) const override;
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const override;
  int acknowledge(const JobKey& key) override;
  [[nodiscard]] std::shared_ptr<DeviceTask> evaluate(const JobKey& key, const std::string& recipe_id) override;

  [[nodiscard]] JobPage list(const JobFilter& filter, std::int64_t before, int most) const override {
    return deps_.store.history().page(filter, before, most);
  }
  [[nodiscard]] ValueList values(const ValueQuery& query) const override { return deps_.store.history().values(query); }

  /// Prepares once, when the devices are up first, the recipe that was prepared when the daemon ended. context: the
  /// machine's thread.
  void restore_prepared();

  /// Asks the job that waits or runs to end.
  void stop_job();

 private:
  using RequestKey = std::pair<std::string, std::int64_t>;  // client and sequence number
  class Claim;
  struct Offer {
    std::string recipe_id;
    std::optional<DeviceFacts> devices;
    std::string objective;  ///< that was confirmed
    HostTime stopped{};     ///< when motion was stopped last
  };

  [[nodiscard]] static RequestKey key_of(const JobRequest& request) { return {request.client, request.seq}; }
  [[nodiscard]] Offer offer(const JobRequest& request);
  [[nodiscard]] AcceptedJob made_durable(const JobRequest& request, const Offer& offer);
  void accept(const AcceptedJob& job, const Offer& offer);
  [[nodiscard]] Recipe checked_recipe(const Offer& offer) const;
  [[nodiscard]] std::optional<StoredJob> stored_evaluation(const JobKey& key) const;
  [[nodiscard]] std::optional<JobStatus> on_board(const JobKey& key) const;

  const Dependencies deps_;
  bool restored_ = false;

  Mutex mutex_;
  Condition claim_ended_;
  std::set<RequestKey> claimed_ FVD_GUARDED_BY(mutex_);  ///< requests that are being answered
  std::string stoppable_ FVD_GUARDED_BY(mutex_);         ///< id of the job that stop_ ends
  std::stop_source stop_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
