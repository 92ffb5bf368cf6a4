#pragma once

/// A job service without devices: jobs run until the test ends them.

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "core/base/error.hpp"
#include "daemon/jobs/alarm_log.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// One recipe, chapter, and what was asked of it.
class FakeRecipes final : public RecipeService {
 public:
  [[nodiscard]] std::vector<RecipeEntry> list() const override { return {{"chapter", true, 3}}; }
  [[nodiscard]] RecipeVersion get(const std::string& id) const override {
    return {.id = id, .version = 3, .text = R"({"scan": {"slices": 21}})"};
  }
  [[nodiscard]] Recipe load(const std::string&) const override { return {}; }
  [[nodiscard]] RecipeCheck check(const std::string& text, const std::string&) const override {
    if (text == "{}") return {"recipe x: /format: is missing", {}, ""};
    return {"", {"has format 1"}, "abc"};
  }
  std::int64_t save(const RecipeSave& request) override {
    if (request.base_version != 3) throw Error(ErrorCode::kRecipeConflict, "saved by 'anna'");
    saved = request;
    return 4;
  }
  [[nodiscard]] std::vector<RecipeVersion> versions(const std::string& id) const override {
    return {{.id = id, .version = 3, .sha256 = "abc", .author = "anna", .saved_utc = "2026-11-28T10:00:00.000Z"}};
  }
  std::int64_t restore(const std::string&, std::int64_t version, std::int64_t base, const std::string&) override {
    restored = version;
    return base + 1;
  }
  RecipeSave saved;
  std::int64_t restored = -1;
};

/// Two objectives, of which one may be confirmed.
class FakeObjectives final : public ObjectiveService {
 public:
  [[nodiscard]] Known known() const override {
    return {{{"20x", 0.4, 20.0, 11.0}, {"50x", 0.5, 50.0, 3.1, -100.0, 50.0}}, confirmed};
  }
  ObjectiveConfirmation confirm(const std::string& name, const std::string& person) override {
    if (busy) throw Error(ErrorCode::kBusy, "a job runs");
    if (name != "20x" && name != "50x") throw Error(ErrorCode::kBadInput, "'" + name + "' is no objective");
    return confirmed.emplace(ObjectiveConfirmation{name, person, "2026-11-29T10:00:00.000Z"});
  }
  std::optional<ObjectiveConfirmation> confirmed;
  bool busy = false;
};

/// One study, and constants made of it.
class FakeStudies final : public StudyService {
 public:
  std::shared_ptr<DeviceTask> begin(StudyRequest request) override {
    if (busy) throw Error(ErrorCode::kBusy, "another study is being made");
    begun = std::move(request);
    task = std::make_shared<DeviceTask>(DeviceTask::Work{});
    return task;
  }
  [[nodiscard]] Study get(const std::string& id) const override {
    if (id != "study-0001") throw Error(ErrorCode::kStudyRefused, "there is no study '" + id + "'");
    Study study;
    study.id = id;
    study.kind = "calibrate.z";
    study.proposal = Calibration{};
    return study;
  }
  [[nodiscard]] std::filesystem::path folder_of(const std::string& id) const override { return "/studies/" + id; }
  [[nodiscard]] std::vector<Study> list() const override { return {get("study-0001")}; }
  [[nodiscard]] std::vector<BrokenStudy> broken() const override { return {{"study-0002", "no valid JSON"}}; }
  AcceptedConstants accept(const AcceptRequest& request) override {
    accepted = request;
    return {calibrations().front(), false};
  }
  [[nodiscard]] std::vector<Calibration> calibrations() const override {
    Calibration first;
    first.id = "cal-0001";
    first.z = ZConstants{};
    first.z->origin.study = "study-0001";
    first.z->origin.renew_by = "2020-01-01";
    Calibration second = first;
    second.id = "cal-0002";
    return {first, second};
  }
  std::optional<StudyRequest> begun;
  std::shared_ptr<DeviceTask> task;
  std::optional<AcceptRequest> accepted;
  bool busy = false;
};

/// Keeps what is noted.
class FakeAudit final : public AuditService {
 public:
  void note(AuditEntry entry) override {
    const std::lock_guard lock(mutex_);
    entry.number = static_cast<std::int64_t>(entries_.size()) + 1;
    entries_.push_back(std::move(entry));
  }
  [[nodiscard]] std::vector<AuditEntry> newest(int most, std::int64_t before) override {
    const std::lock_guard lock(mutex_);
    std::vector<AuditEntry> found;
    for (auto entry = entries_.rbegin(); entry != entries_.rend() && static_cast<int>(found.size()) < most; ++entry) {
      if (before == 0 || entry->number < before) found.push_back(*entry);
    }
    return found;
  }

 private:
  std::mutex mutex_;
  std::vector<AuditEntry> entries_;
};

/// Tells what a test puts there, and keeps what it was asked for.
class FakeHistory final : public HistoryService {
 public:
  struct Asked {
    JobFilter filter;
    std::int64_t before = 0;
    int most = 0;
  };
  [[nodiscard]] JobPage list(const JobFilter& filter, std::int64_t before, int most) const override {
    if (before_list) before_list();
    if (failure) throw Error(*failure);
    asked = {filter, before, most};
    return page;
  }
  [[nodiscard]] ValueList values(const ValueQuery& query) const override {
    if (failure) throw Error(*failure);
    asked_value = query;
    return {points, searched_all};
  }
  JobPage page;
  std::vector<ValuePoint> points;
  bool searched_all = true;
  std::function<void()> before_list;
  std::optional<Error> failure;
  mutable std::optional<Asked> asked;
  mutable std::optional<ValueQuery> asked_value;
};

class FakeJobService final : public MachineView, public JobService, public ResultService, public TaskService {
 public:
  FakeJobService() { alarms.note(AlarmLevel::kWarning, "the disk is nearly full", {}); }

  FakeRecipes recipes;
  FakeObjectives objectives;
  FakeStudies studies;
  AccessConfig access_config;  ///< before services() is called
  std::optional<AccessRules> access;
  ControlLease control{[] { return HostClock::now(); }, [this] { return job_runs; }};
  FakeAudit audit;
  RefusedCalls refusals;
  FakeHistory history;
  AlarmLog alarms;  ///< one that nobody has seen, number 1
  bool job_runs = false;
  [[nodiscard]] Services services() {
    if (!access) access.emplace(access_config);
    return {*this,   *this, *this,   *this,    recipes, objectives, studies,
            control, audit, *access, refusals, history, alarms};
  }

  Started start(const JobRequest& request) override {
    if (before_start) before_start();
    const std::lock_guard lock(mutex_);
    if (refusal) throw Error(*refusal, "refused by the test");
    require_works();
    ++starts;
    const Key key{request.client, request.seq};
    if (const auto known = jobs_.find(key); known != jobs_.end()) return {known->second, true};
    JobStatus job;
    job.job_id = "job-" + (request.client == kDefaultClient ? "" : request.client + "-") + std::to_string(request.seq);
    job.request = request;
    job.slices_planned = 21;
    if (shows_started) current = job;
    return {jobs_[key] = job, false};
  }
  [[nodiscard]] JobStatus job(const JobKey& key) const override {
    require_works();
    const std::lock_guard lock(mutex_);
    for (const auto& [unused, job] : jobs_) {
      if (names(key, job)) return job;
    }
    throw Error(ErrorCode::kUnknownJob, "no such job");
  }
  [[nodiscard]] std::optional<JobStatus> highest(const std::string& client) const override {
    require_works();
    const std::lock_guard lock(mutex_);
    std::optional<JobStatus> found;
    for (const auto& [key, job] : jobs_) {
      if (key.first == client) found = job;
    }
    return found;
  }
  JobStatus abort(const JobKey& key) override { return job(key); }
  std::optional<JobStatus> try_abort(const JobKey& key) override {
    ++abort_tries;
    require_works();
    const std::lock_guard lock(mutex_);
    if (!current || !names(key, *current)) return std::nullopt;
    ++aborts;
    return current;
  }
  std::atomic<int> aborts{0};
  std::atomic<int> abort_tries{0};  ///< of jobs on the board and others
  Stopped stop_motion() override {
    ++stops;
    last_stop = HostClock::now();
    return Stopped::kCommand;
  }
  [[nodiscard]] bool stopped_since(HostTime time) const override { return last_stop.load() > time; }
  std::atomic<int> stops{0};
  std::atomic<HostTime> last_stop{HostTime{}};
  void jog(const JogRequest& request) override {
    if (refuse_tasks) throw Error(ErrorCode::kBusy, "a job is running");
    jogs.push_back(request);
  }
  bool extend_jog(const JogRequest& request) override {
    if (jogs.empty() || !jogs.back().repeats(request)) return false;
    jogs.push_back(request);
    return true;
  }
  std::vector<JogRequest> jogs;
  [[nodiscard]] StoredJob stored(const JobKey& key) const override {
    const JobStatus found = job(key);
    if (found.state != JobState::kCompleted) return {found, "", ""};
    return {found, result_dir, result};
  }
  /// Done only when a test ends it.
  std::shared_ptr<DeviceTask> evaluate(const JobKey& key, const std::string& recipe_id) override {
    static_cast<void>(job(key));
    evaluated_by = recipe_id;
    task = std::make_shared<DeviceTask>(DeviceTask::Work{});
    return task;
  }
  std::string evaluated_by;
  [[nodiscard]] std::optional<StepHistorySummary> stage_history() const override { return stage_steps; }
  std::optional<StepHistorySummary> stage_steps;
  [[nodiscard]] std::optional<JobStatus> next_unacknowledged() const override {
    require_works();
    const std::lock_guard lock(mutex_);
    for (const auto& [unused, job] : jobs_) {
      if (job.state != JobState::kProcessing && !job.acknowledged) return job;
    }
    return std::nullopt;
  }
  int acknowledge(const JobKey& key) override {
    const JobStatus found = job(key);
    const std::lock_guard lock(mutex_);
    jobs_[{found.request.client, found.request.seq}].acknowledged = true;
    return remaining;
  }
  void prepare(const std::string& recipe_id) override {
    if (recipe_id != "chapter") throw Error(ErrorCode::kUnknownRecipe, "no recipe '" + recipe_id + "'");
  }
  [[nodiscard]] std::shared_ptr<const MachineStatus> snapshot() const override {
    const std::lock_guard lock(mutex_);
    if (machine) return std::make_shared<const MachineStatus>(*machine);
    MachineStatus status;
    status.state = ScanState::kReady;
    status.signals = {.ready = true, .part_release = true};
    status.epoch = 17;
    status.job = current;
    if (objectives.confirmed) status.objective = objectives.confirmed->objective;
    return std::make_shared<const MachineStatus>(status);
  }
  [[nodiscard]] bool stage_stands() const override {
    if (unseen_looks > 0) {
      --unseen_looks;
      return false;
    }
    return snapshot()->signals.part_release;
  }
  mutable std::atomic<int> unseen_looks{0};  ///< so many do not see it stand
  /// Done only when a test runs it.
  std::shared_ptr<DeviceTask> submit(DeviceTask::Work work, TaskMotion motion, HostTime /*asked*/) override {
    motions.push_back(motion);
    if (refuse_tasks) throw Error(ErrorCode::kBusy, "a job is running");
    task = std::make_shared<DeviceTask>(std::move(work));
    return task;
  }
  std::shared_ptr<DeviceTask> preview(const CameraSettings& settings) override {
    if (before_preview) before_preview();
    previewed = settings;
    return submit([](const Devices&, std::stop_token) { return std::string(R"({"seq": 1})"); }, TaskMotion::kNone, {});
  }
  std::vector<TaskMotion> motions;  ///< of the commands so far
  std::shared_ptr<DeviceTask> task;
  std::optional<CameraSettings> previewed;
  bool refuse_tasks = false;

  void on_change(std::function<void()> listener, const void* whose) override {
    const std::lock_guard lock(mutex_);
    if (listener) {
      listeners_[whose] = std::move(listener);
    } else {
      listeners_.erase(whose);
    }
  }

  /// Changes a job and tells the listener, as the machine's thread would.
  void change(const ClientSeq& number, const std::function<void(JobStatus&)>& how) {
    std::map<const void*, std::function<void()>> listeners;
    {
      const std::lock_guard lock(mutex_);
      how(jobs_.at({number.client, number.seq}));
      listeners = listeners_;
    }
    for (const auto& [whose, listener] : listeners) listener();
  }

  /// What the snapshot tells of its job.
  void change_current(const std::function<void(JobStatus&)>& how) {
    const std::lock_guard lock(mutex_);
    how(current.value());
  }

  /// In a test that has start() block.
  std::function<void()> before_start;
  /// Likewise preview().
  std::function<void()> before_preview;
  /// The snapshot's job.
  std::optional<JobStatus> current;
  bool shows_started = false;  ///< in the snapshot
  int starts = 0;
  std::optional<ErrorCode> refusal;
  /// What every question for jobs and results fails with.
  std::optional<Error> failure;
  /// In place of a machine that is ready.
  std::optional<MachineStatus> machine;
  std::string result_dir = "/results/x";
  int remaining = 0;
  std::string result =
      R"({"values":{"height":{"min_um":-1.25,"max_um":100.5,"mean_um":50.0,"median_um":49.0},"valid_fraction":0.97},)"
      R"("focus":{"peak":"parabola","extra_peaks":[]},"frames":{"expected":21,"ok":21},"slices":{"planned":21},)"
      R"("steps":{"steps":21},"times":{"scan_ms":1700.0},"provenance":{"simulated":true}})";

 private:
  void require_works() const {
    if (failure) throw Error(*failure);
  }

  mutable std::mutex mutex_;
  using Key = std::pair<std::string, std::int64_t>;
  std::map<Key, JobStatus> jobs_;
  std::map<const void*, std::function<void()>> listeners_;
};

}  // namespace fvd
