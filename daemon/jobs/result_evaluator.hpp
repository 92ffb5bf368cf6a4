#pragma once

/// Evaluates stored results anew by other recipes, one at a time, beside the machine: no device is touched.

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include "core/base/mutex.hpp"
#include "daemon/jobs/device_task.hpp"
#include "daemon/jobs/machine_board.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/store/job_store.hpp"

namespace fvd {

/// A record is files first, in results/<job_id>-e<n>, then a row. Its thread computes alone, so that the cores stay
/// with a job that runs meanwhile. context: thread-safe.
class ResultEvaluator {
 public:
  struct Dependencies {
    JobStore& store;
    MachineBoard& board;  ///< whose listener is told when an evaluation is done
    std::filesystem::path results_dir;
    std::filesystem::path calibration_dir;  ///< with the reference maps that results name
    std::size_t memory_bytes = 0;           ///< budget of one evaluation; a job that runs beside it has its own
  };
  explicit ResultEvaluator(Dependencies dependencies);
  /// finish().
  ~ResultEvaluator();
  ResultEvaluator(const ResultEvaluator&) = delete;
  ResultEvaluator& operator=(const ResultEvaluator&) = delete;

  /// The task ends with a JSON object: id, job_id, recipe, verdict (may be null), directory. Throws Error kBadInput
  /// where the job has no result, kResultRemoved where it has none any more, kBadRecipe where the recipe measures
  /// nothing, kMemoryBudget with the figures, kBusy while another one is under way, kShuttingDown.
  [[nodiscard]] std::shared_ptr<DeviceTask> begin(const StoredJob& source, const Recipe& recipe);

  /// Takes no more. Waits for what runs, seconds at most; what has not begun is answered with kShuttingDown. May be
  /// repeated.
  void finish();

 private:
  struct Order {
    StoredJob source;
    Recipe recipe;
    std::shared_ptr<DeviceTask> task;
  };
  void run(const std::stop_token& stop);
  [[nodiscard]] DeviceTask::Outcome outcome_of(const Order& order) const noexcept;
  [[nodiscard]] std::string evaluated(const Order& order) const;

  const Dependencies deps_;
  Mutex mutex_;
  Condition changed_;
  bool closed_ FVD_GUARDED_BY(mutex_) = false;
  bool busy_ FVD_GUARDED_BY(mutex_) = false;
  std::optional<Order> waiting_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd
