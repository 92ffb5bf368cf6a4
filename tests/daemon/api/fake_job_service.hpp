#pragma once

/// A job service without devices: jobs run until the test ends them.

#include <functional>
#include <map>
#include <mutex>

#include "core/base/error.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

class FakeJobService final : public MachineView,
                             public JobService,
                             public ResultService,
                             public TaskService,
                             public RecipeService {
 public:
  [[nodiscard]] Services services() { return {*this, *this, *this, *this, *this}; }

  Started start(const JobRequest& request) override {
    if (before_start) before_start();
    const std::lock_guard lock(mutex_);
    if (refusal) throw Error(*refusal, "refused by the test");
    ++starts;
    if (const auto known = jobs_.find(request.seq); known != jobs_.end()) return {known->second, true};
    JobStatus job;
    job.job_id = "job-" + std::to_string(request.seq);
    job.request = request;
    job.slices_planned = 21;
    return {jobs_[request.seq] = job, false};
  }
  [[nodiscard]] JobStatus job(const JobKey& key) const override {
    const std::lock_guard lock(mutex_);
    for (const auto& [seq, job] : jobs_) {
      if (names(key, job)) return job;
    }
    throw Error(ErrorCode::kUnknownJob, "no such job");
  }
  JobStatus abort(const JobKey& key) override { return job(key); }
  [[nodiscard]] std::string result_json(const JobKey& key) const override {
    return job(key).state == JobState::kCompleted ? result : "";
  }
  [[nodiscard]] std::string result_dir(const JobKey& key) const override {
    return job(key).state == JobState::kCompleted ? "/results/x" : "";
  }
  [[nodiscard]] std::optional<StepHistorySummary> stage_history() const override { return history; }
  std::optional<StepHistorySummary> history;
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const override {
    const std::lock_guard lock(mutex_);
    for (const auto& [seq, job] : jobs_) {
      if (job.state != JobState::kProcessing && !job.acknowledged) return job;
    }
    return std::nullopt;
  }
  int acknowledge(const JobKey& key) override {
    const JobStatus found = job(key);
    const std::lock_guard lock(mutex_);
    jobs_[found.request.seq].acknowledged = true;
    return 0;
  }
  void prepare(const std::string& recipe_id) override {
    if (recipe_id != "chapter") throw Error(ErrorCode::kUnknownRecipe, "no recipe '" + recipe_id + "'");
  }
  [[nodiscard]] std::vector<std::string> recipe_ids() const override { return {"chapter"}; }
  [[nodiscard]] std::string recipe_json(const std::string&) const override { return R"({"scan": {"slices": 21}})"; }
  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override {
    MachineStatus status;
    status.state = ScanState::kReady;
    status.signals = {.ready = true, .part_release = true};
    status.epoch = 17;
    status.job = current;
    return std::make_shared<const MachineStatus>(status);
  }
  /// Done only when a test runs it.
  std::shared_ptr<DeviceTask> submit(DeviceTask::Work work, TaskMotion motion) override {
    motions.push_back(motion);
    if (refuse_tasks) throw Error(ErrorCode::kBusy, "a job is running");
    task = std::make_shared<DeviceTask>(std::move(work));
    return task;
  }
  std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) override {
    previewed = settings;
    return submit([](const Devices&, std::stop_token) { return std::string(R"({"seq": 1})"); }, TaskMotion::kNone);
  }
  std::vector<TaskMotion> motions;  ///< of the commands so far
  std::shared_ptr<DeviceTask> task;
  std::optional<CameraSettings> previewed;
  bool refuse_tasks = false;

  void on_change(std::function<void()> listener) override {
    const std::lock_guard lock(mutex_);
    listener_ = std::move(listener);
  }

  /// Changes a job and tells the listener, as the engine's thread would.
  void change(std::int64_t seq, const std::function<void(JobStatus&)>& how) {
    std::function<void()> listener;
    {
      const std::lock_guard lock(mutex_);
      how(jobs_.at(seq));
      listener = listener_;
    }
    if (listener) listener();
  }

  /// In a test that has start() block.
  std::function<void()> before_start;
  /// The snapshot's job.
  std::optional<JobStatus> current;
  int starts = 0;
  std::optional<ErrorCode> refusal;
  std::string result =
      R"({"values":{"height":{"min_um":-1.25,"max_um":100.5,"mean_um":50.0,"median_um":49.0},"valid_fraction":0.97},)"
      R"("focus":{"peak":"parabola","extra_peaks":[]},"frames":{"expected":21,"ok":21},"slices":{"planned":21},)"
      R"("steps":{"steps":21},"times":{"scan_ms":1700.0},"provenance":{"simulated":true}})";

 private:
  mutable std::mutex mutex_;
  std::map<std::int64_t, JobStatus> jobs_;
  std::function<void()> listener_;
};

}  // namespace fvd
