#include "daemon/jobs/result_evaluator.hpp"

#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/base/version.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/jobs/reconcile_results.hpp"
#include "daemon/pipeline/evaluation_record.hpp"
#include "daemon/pipeline/job_memory.hpp"
#include "daemon/pipeline/reference_input.hpp"

namespace fvd {

namespace {

constexpr std::chrono::minutes kLongestEvaluation{10};

void require_result(const StoredJob& source) {
  const JobStatus& job = source.status;
  if (job.state == JobState::kProcessing) {
    throw Error(ErrorCode::kBusy, "job " + job.job_id + " is still running; evaluate it when it has ended");
  }
  require_not_removed(job);
  if (!source.result_json.empty() && !source.result_dir.empty()) return;
  throw Error(ErrorCode::kBadInput, "job " + job.job_id + " has no result that could be evaluated: it " +
                                        std::string(job_state_name(job.state)) +
                                        (job.error ? ", " + std::string(error_name(*job.error)) : std::string()));
}

void require_evaluation(const Recipe& recipe) {
  if (!recipe.evaluation.empty()) return;
  throw Error(ErrorCode::kBadRecipe,
              "recipe " + recipe.id + ": /evaluation: has no measurements, so that there is nothing to do");
}

}  // namespace

ResultEvaluator::ResultEvaluator(Dependencies dependencies)
    : deps_(std::move(dependencies)),
      thread_(start_thread("fvd-evaluate", [this](const std::stop_token& stop) { run(stop); })) {}

ResultEvaluator::~ResultEvaluator() { finish(); }

std::shared_ptr<DeviceTask> ResultEvaluator::begin(const StoredJob& source, const Recipe& recipe) {
  require_result(source);
  require_evaluation(recipe);
  const Result result = read_result_json(source.result_json);
  require_evaluation_memory(recipe, result.focus.width_px, result.focus.height_px, deps_.memory_bytes);
  auto task = std::make_shared<DeviceTask>(DeviceTask::Work{});
  {
    const MutexLock lock(mutex_);
    if (closed_) throw Error(ErrorCode::kShuttingDown, "the daemon is being shut down; ask again when it is back");
    if (busy_) {
      throw Error(ErrorCode::kBusy, "another result is being evaluated; ask again in a few seconds");
    }
    busy_ = true;
    waiting_ = Order{source, recipe, task};
  }
  changed_.notify_one();
  return task;
}

void ResultEvaluator::finish() {
  std::optional<Order> refused;
  {
    const MutexLock lock(mutex_);
    closed_ = true;
    refused = std::exchange(waiting_, std::nullopt);
  }
  if (refused) {
    refused->task->fail(ErrorCode::kShuttingDown,
                        "the daemon was shut down before this could begin; ask again when it is back");
    deps_.board.update([](MachineRecord&) {});  // its caller is told
  }
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void ResultEvaluator::run(const std::stop_token& stop) {
  ThreadTicks ticks("fvd-evaluate", kLongestEvaluation);
  for (;;) {
    std::optional<Order> order;
    {
      MutexLock lock(mutex_);
      const bool has_order = changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return waiting_.has_value();
      });
      if (!has_order || stop.stop_requested()) return;
      order = std::exchange(waiting_, std::nullopt);
    }
    ticks.tick(HostClock::now());
    DeviceTask::Outcome outcome = outcome_of(*order);
    {
      const MutexLock lock(mutex_);
      busy_ = false;  // before the answer: who reads it may ask for the next
    }
    order->task->end(std::move(outcome));
    ticks.rest();
    deps_.board.update([](MachineRecord&) {});  // its caller is told
  }
}

DeviceTask::Outcome ResultEvaluator::outcome_of(const Order& order) const noexcept {
  const std::string& job_id = order.source.status.job_id;
  const auto failed = [&job_id](ErrorCode code, const std::string& why) {
    spdlog::error("job {} was not evaluated anew: {}: {}", job_id, error_name(code), why);
    return DeviceTask::Outcome{{}, code, why};
  };
  try {
    return {evaluated(order), std::nullopt, {}};
  } catch (const Error& error) {
    return failed(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return failed(ErrorCode::kMemoryBudget, "there is not enough memory to evaluate job " + job_id);
  } catch (const std::exception& error) {
    return failed(ErrorCode::kInternal, error.what());
  }
}

std::string ResultEvaluator::evaluated(const Order& order) const {
  const std::string& job_id = order.source.status.job_id;
  EvaluationTable& table = deps_.store.evaluations();
  StoredEvaluation row;
  row.job_id = job_id;
  row.number = table.newest_number(job_id) + 1;
  // A folder without a row is what a process left that ended between the two; its number is not used again.
  while (std::filesystem::exists(deps_.results_dir / evaluation_id(job_id, row.number))) ++row.number;
  row.id = evaluation_id(job_id, row.number);
  row.recipe = order.recipe.id;
  row.recipe_sha256 = order.recipe.sha256;
  AtomicDirectory directory(deps_.results_dir / row.id);
  StoredSurface source = read_stored_surface(order.source.result_dir);
  read_reference_of(deps_.calibration_dir, order.recipe.evaluation, source.context);
  const EvaluationRecord record = write_evaluation_record(
      directory, source, order.recipe, {row.id, kVersion, std::chrono::system_clock::now()}, nullptr);
  directory.commit();
  if (record.verdict) row.verdict = verdict_name(*record.verdict);
  row.result_dir = directory.final_dir().string();
  row.result_json = record.json;
  try {
    table.add(row);
  } catch (...) {
    // Nobody may find it. But a disk that failed at the commit's end may have the row, which the next start tells then:
    // it looks for the folder under this name, and removes it where there is no row.
    const std::filesystem::path hidden = deps_.results_dir / refused_evaluation(row.id);
    file_calls().remove_all(hidden);
    (void)file_calls().rename(row.result_dir, hidden);
    throw;
  }
  spdlog::info("job {} was evaluated by recipe {}: {}", job_id, row.recipe, row.result_dir);
  return nlohmann::ordered_json{
      {"id", row.id},
      {"job_id", job_id},
      {"recipe", row.recipe},
      {"verdict", row.verdict.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(row.verdict)},
      {"directory", row.result_dir}}
      .dump();
}

}  // namespace fvd
