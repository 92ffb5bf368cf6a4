/// Every place of the daemon that writes what belongs to a job: each call fails, in every way that disks fail.

#include "daemon/export/result_json.hpp"
#include "daemon/jobs/follow_result.hpp"
#include "daemon/jobs/reconcile_results.hpp"
#include "daemon/jobs/result_pipeline.hpp"
#include "daemon/jobs/retention.hpp"
#include "daemon/store/database_copy.hpp"
#include "daemon/store/stage_history.hpp"
#include "daemon/store/store_marker.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/daemon/jobs/write_site.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using test::AWriteSite;
using test::WriteSite;

/// Empty where all that result.json tells as written is there as it tells.
std::string lacks(const fs::path& folder) {
  if (!fs::exists(folder / "result.json")) return folder.string() + " has no result.json";
  for (const ResultFile& file : read_result_json(test::read_text(folder / "result.json")).files) {
    if (file.state != FileState::kWritten) continue;
    std::error_code error;
    if (file.files ? !fs::is_directory(folder / file.name)
                   : fs::file_size(folder / file.name, error) != file.size_bytes)
      return file.name + " is not whole";
  }
  return {};
}

class AResult final : public WriteSite {
 public:
  explicit AResult(const fs::path& folder) : folder_(folder) {}
  void work() override {
    told_ = false;
    AtomicDirectory directory(folder_ / "J7");
    (void)store_result(directory, test::sample_result());
    told_ = true;
  }
  /// A whole one of a job that was told without it is set aside then: AReconciliation.
  void clear() override {
    remove_abandoned_directories(folder_);
    if (!told_) fs::remove_all(folder_ / "J7");
  }
  std::string wrong(bool done) override {
    if (done) return lacks(folder_ / "J7");
    return fs::is_empty(folder_) ? "" : "something is left";
  }

 private:
  const fs::path folder_;
  bool told_ = false;
};

class FilesThatFollow final : public WriteSite {
 public:
  explicit FilesThatFollow(const fs::path& folder) : result_(folder / "J7") {
    AtomicDirectory directory(result_);
    (void)store_result(directory, test::sample_result());
  }
  void work() override {
    const FollowedResult followed =
        follow_result({"J7", result_.string(), test::read_text(result_ / "result.json"), {}}, {});
    if (!followed.pending) return;
    const bool full = followed.reason.find(std::generic_category().message(ENOSPC)) != std::string::npos;
    throw Error(full ? ErrorCode::kStorageFull : ErrorCode::kStorageWrite, followed.reason);
  }
  std::string wrong(bool done) override {
    const auto files = read_result_json(test::read_text(result_ / "result.json")).files;
    const bool pending = std::any_of(files.begin(), files.end(),
                                     [](const ResultFile& file) { return file.state == FileState::kPending; });
    return done && pending ? "files are still pending" : lacks(result_);
  }

 private:
  const fs::path result_;
};

class AMarker final : public WriteSite {
 public:
  explicit AMarker(const fs::path& folder) : database_(folder / "fvd.sqlite") {
    write_marker(database_, {.epoch = 1, .newest_seq = {}, .file = {}});
  }
  void work() override { write_marker(database_, {.epoch = 2, .newest_seq = {{"plc", 7}}, .file = {}}); }
  std::string wrong(bool done) override {
    const std::int64_t epoch = read_marker(database_).value().epoch;
    return epoch == 2 || (epoch == 1 && !done) ? "" : "the epoch is " + std::to_string(epoch);
  }

 private:
  const fs::path database_;
};

/// With the room that is held for its end.
class AnAcceptance final : public WriteSite {
 public:
  explicit AnAcceptance(const fs::path& folder) : store_(folder / "fvd.sqlite") {}
  void work() override { (void)store_.accept({7, "part", "chapter"}); }
  std::string wrong(bool done) override {
    return is_known() == done ? "" : done ? "the job is not known" : "a job that was refused is there";
  }

 private:
  [[nodiscard]] bool is_known() const {
    try {
      (void)store_.find(ClientSeq{7});
      return true;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kUnknownJob) throw;
      return false;
    }
  }
  JobStore store_;
};

class ANewStore final : public WriteSite {
 public:
  explicit ANewStore(const fs::path& folder) : file_(folder / "state" / "fvd.sqlite") {}
  void work() override { epochs_.push_back(JobStore(file_).epoch()); }
  std::string wrong(bool done) override {
    if (epochs_.size() > 1 && epochs_.back() <= epochs_.front()) return "an epoch runs twice";
    return done == !epochs_.empty() ? "" : "it was not opened";
  }

 private:
  const fs::path file_;
  std::vector<std::int64_t> epochs_;
};

/// A copy before the first step, then the steps.
class AnOldDatabase final : public WriteSite {
 public:
  explicit AnOldDatabase(const fs::path& folder) : file_(folder / "fvd.sqlite") {
    fs::copy_file(FVD_TEST_DATA "/fvd_0.1.0.sqlite", file_);
  }
  void work() override { jobs_ = JobStore(file_).unacknowledged_results(); }
  std::string wrong(bool done) override {
    if (done && !fs::exists(file_.string() + ".v1")) return "no copy was kept";
    if (done && jobs_ <= 0) return "its results are not known";
    return fs::exists(file_.string() + ".v1.tmp") ? "a part of the copy is left" : "";
  }
  void clear() override { fs::remove(file_.string() + ".v1.tmp"); }  // the next copy's first step

 private:
  const fs::path file_;
  int jobs_ = 0;
};

class AStageHistory final : public WriteSite {
 public:
  explicit AStageHistory(const fs::path& folder) : file_(folder / "stage_history.json"), history_(file_) { work(); }
  void work() override {
    StepLog log(5);
    for (StepRecord& step : log) step.error_um = 0.1;
    history_.add(FeedbackSource::kMotorEncoder, log);
    ++scans_;
  }
  std::string wrong(bool done) override {
    if (history_.summary()->scans != scans_) return "a scan is forgotten";
    const StageHistory stored(file_);
    if (!stored.summary()) return "the file is gone";
    return !done || stored.summary()->scans == scans_ ? "" : "a scan is not stored";
  }
  [[nodiscard]] bool keeps_failures_to_itself() const override { return true; }

 private:
  const fs::path file_;
  StageHistory history_;
  std::uint64_t scans_ = 0;
};

/// Removes an old result with its evaluation, and the slices of another.
class ARetention final : public WriteSite {
 public:
  explicit ARetention(const fs::path& folder)
      : results_(folder / "results"), store_(folder / "fvd.sqlite"), old_(add(1, false)), with_slices_(add(2, true)) {
    fs::create_directories(results_ / (old_ + "-e1"));
  }
  void work() override {
    Retention(store_, {.keep_days = 30}, results_).run_once();
    Retention(store_, {.keep_gib = 1}, results_).run_once();
  }
  void clear() override { remove_abandoned_directories(results_); }
  std::string wrong(bool done) override {
    const StoredJob old = store_.find(old_);
    if (old.status.removed_utc.empty() && !fs::exists(results_ / old_)) return "a result went before it was told";
    if (fs::exists(results_ / old_) && !fs::exists(results_ / old_ / "result.json"))
      return "a part of a result is left";
    const std::string told = store_.find(with_slices_).result_json;
    const fs::path slices = results_ / with_slices_ / "slices";
    const bool gone = read_result_json(told).files.at(0).state == FileState::kNotMade;
    if (!gone && !fs::exists(slices)) return "slices went before it was told";
    if (!done) return {};
    if (fs::exists(results_ / old_) || fs::exists(results_ / (old_ + "-e1"))) return "the old result is still there";
    return gone && !fs::exists(slices) ? "" : "the slices are still there";
  }
  [[nodiscard]] bool keeps_failures_to_itself() const override { return true; }

 private:
  std::string add(std::int64_t seq, bool large) {
    JobStatus job = store_.accept({seq, "part", "chapter"});
    job.state = JobState::kCompleted;
    job.ended_utc = large ? utc_now() : "2020-01-01T00:00:00.000Z";
    Result result;
    result.job.id = job.job_id;
    result.files = {{.name = "slices/", .files = 1}};
    const std::string text = result_json_text(result);
    const fs::path folder = results_ / job.job_id;
    fs::create_directories(folder / "slices");
    test::write_text(folder / "result.json", text);
    test::write_text(folder / "slices" / "a.pgm", "");
    if (large) fs::resize_file(folder / "slices" / "a.pgm", std::uintmax_t{2} << 30U);
    store_.finish(job, folder.string(), text);
    (void)store_.acknowledge(job.job_id);
    return job.job_id;
  }
  const fs::path results_;
  JobStore store_;
  const std::string old_;
  const std::string with_slices_;
};

/// The start after a kill: a whole result that was told as interrupted, and a part of one.
class AReconciliation final : public WriteSite {
 public:
  explicit AReconciliation(const fs::path& folder) : folder_(folder) {
    {
      JobStore store(folder / "fvd.sqlite");
      whole_ = store.accept({1, "part", "chapter"}).job_id;
      part_ = store.accept({2, "part", "chapter"}).job_id;
    }
    ResultData data = test::sample_result();
    data.job_id = whole_;
    fs::create_directories(results_ / part_);
    AtomicDirectory directory(results_ / whole_);
    (void)store_result(directory, data);
    test::write_text(results_ / part_ / "result.json", "{");
    { const JobStore told(folder / "fvd.sqlite"); }
    store_ = std::make_unique<JobStore>(folder / "fvd.sqlite");
  }
  void work() override { (void)reconcile_results(*store_, results_); }
  std::string wrong(bool done) override {
    if (store_->find(ClientSeq{1}).status.state == JobState::kCompleted) return "what was told has changed";
    const bool kept = fs::exists(results_ / whole_ / "result.json");
    const bool aside = fs::exists(folder_ / "set-aside" / whole_ / "result.json");
    if (kept == aside) return "the whole result is lost, or there twice";
    return done && (kept || fs::exists(results_ / part_)) ? "something is left" : "";
  }
  [[nodiscard]] bool keeps_failures_to_itself() const override { return true; }

 private:
  const fs::path folder_;
  const fs::path results_ = folder_ / "results";
  std::string whole_;
  std::string part_;
  std::unique_ptr<JobStore> store_;
};

TEST_P(AWriteSite, EndsEveryFaultWithoutHalves) { test::EveryWriteFault(GetParam()).run(); }

INSTANTIATE_TEST_SUITE_P(
    OfJobs, AWriteSite,
    testing::Values(test::write_site<AResult>("Result"), test::write_site<FilesThatFollow>("FilesThatFollow", 8),
                    test::write_site<AMarker>("Marker"), test::write_site<AnAcceptance>("Acceptance", 2),
                    test::write_site<ANewStore>("NewStore"), test::write_site<AnOldDatabase>("OldDatabase"),
                    test::write_site<AStageHistory>("StageHistory"), test::write_site<ARetention>("Retention"),
                    test::write_site<AReconciliation>("Reconciliation")),
    [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace fvd
