#include "daemon/jobs/retention.hpp"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/export/result_json.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;

TEST(ARetentionPlan, RemovesNothingWithoutALimit) {
  EXPECT_TRUE(retention_plan({{1'000'000'000, 100, 50, true}}, {}, 0).empty());
}

TEST(ARetentionPlan, RemovesOldResultsButNoneThatIsNotRemovable) {
  const std::vector<KeptResult> results{
      {300, 10, 0, true}, {200, 10, 0, false}, {101, 10, 0, true}, {100, 10, 0, true}};
  EXPECT_EQ(retention_plan(results, {.longest_s = 100}, 0), (std::vector<RetentionStep>{{0, false}, {2, false}}));
}

TEST(ARetentionPlan, RemovesSlicesBeforeResultsAndTheOldestFirstUntilItFits) {
  const std::vector<KeptResult> results{{4, 100, 60, true}, {3, 100, 60, false}, {2, 100, 60, true}, {1, 100, 0, true}};
  using Steps = std::vector<RetentionStep>;
  EXPECT_EQ(retention_plan(results, {.most_bytes = 400}, 0), Steps{});
  EXPECT_EQ(retention_plan(results, {.most_bytes = 399}, 0), (Steps{{0, true}}));
  EXPECT_EQ(retention_plan(results, {.most_bytes = 280}, 0), (Steps{{0, true}, {2, true}}));
  EXPECT_EQ(retention_plan(results, {.most_bytes = 279}, 0), (Steps{{0, true}, {2, true}, {0, false}}));
  EXPECT_EQ(retention_plan(results, {.most_bytes = 0}, 0),
            (Steps{{0, true}, {2, true}, {0, false}, {2, false}, {3, false}}))
      << "all but the one that is not acknowledged";
  EXPECT_EQ(retention_plan(results, {.least_free_bytes = 150}, 50), (Steps{{0, true}, {2, true}}));
  EXPECT_EQ(retention_plan(results, {.least_free_bytes = 50}, 50), Steps{});
}

class ARetention : public testing::Test {
 protected:
  std::string add(std::int64_t seq, bool acknowledged, const std::string& ended_utc) {
    JobStatus job = store_.accept({seq, "part", "chapter"});
    job.state = JobState::kCompleted;
    job.ended_utc = ended_utc;
    job.verdict = "pass";
    const fs::path folder = results_ / job.job_id;
    fs::create_directories(folder / "slices");
    test::write_text(folder / "result.json", "{}");
    store_.finish(job, folder.string(), "{}");
    if (acknowledged) (void)store_.acknowledge(job.job_id);
    return job.job_id;
  }
  static constexpr const char* kLongAgo = "2020-01-01T00:00:00.000Z";
  test::ScratchDir folder_;
  fs::path results_ = folder_ / "results";
  JobStore store_{folder_ / "fvd.sqlite"};
};

TEST_F(ARetention, RemovesAcknowledgedResultsThatAreOldAndSaysSo) {
  const std::string old = add(1, true, kLongAgo);
  const std::string waiting = add(2, false, kLongAgo);
  const std::string young = add(3, true, utc_now());
  Retention retention(store_, {.keep_days = 30}, results_);
  retention.run_once();
  EXPECT_FALSE(fs::exists(results_ / old));
  EXPECT_TRUE(fs::exists(results_ / waiting));
  EXPECT_TRUE(fs::exists(results_ / young));
  const StoredJob removed = store_.find(old);
  EXPECT_NE(removed.status.removed_utc, "");
  EXPECT_EQ(removed.result_json, "");
  EXPECT_EQ(removed.status.verdict, "pass") << "what it came to stays";
  EXPECT_EQ(store_.find(waiting).status.removed_utc, "");
  EXPECT_EQ(store_.find(young).result_json, "{}");
  for (const auto& entry : fs::directory_iterator(results_)) {
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
  }
}

TEST_F(ARetention, CountsEvaluationsAndRemovesThemWithTheirJob) {
  const std::string old = add(1, true, kLongAgo);
  const std::string waiting = add(2, false, kLongAgo);
  for (const std::string& id : {old, waiting}) fs::create_directories(results_ / (id + "-e1"));
  test::write_text(results_ / (old + "-e1") / "result.json", "");
  fs::resize_file(results_ / (old + "-e1") / "result.json", std::uintmax_t{2} << 30U);
  Retention retention(store_, {.keep_gib = 1}, results_);
  retention.run_once();
  EXPECT_FALSE(fs::exists(results_ / old)) << "with its evaluation it is above the limit";
  EXPECT_FALSE(fs::exists(results_ / (old + "-e1")));
  EXPECT_TRUE(fs::exists(results_ / (waiting + "-e1")));
}

TEST_F(ARetention, TellsThatSlicesAreGone) {
  JobStatus job = store_.accept({1, "part", "chapter"});
  job.state = JobState::kCompleted;
  job.ended_utc = kLongAgo;
  Result result;
  result.job.id = job.job_id;
  result.files = {{.name = "slices/", .files = 2}, {.name = "height.tiff", .size_bytes = 1}};
  const fs::path folder = results_ / job.job_id;
  fs::create_directories(folder / "slices");
  const std::string before = result_json_text(result);
  test::write_text(folder / "result.json", before);
  test::write_text(folder / "slices" / "a.pgm", "");
  fs::resize_file(folder / "slices" / "a.pgm", std::uintmax_t{2} << 30U);
  store_.finish(job, folder.string(), before);
  (void)store_.acknowledge(job.job_id);
  Retention retention(store_, {.keep_gib = 1}, results_);
  retention.run_once();
  EXPECT_FALSE(fs::exists(folder / "slices"));
  const std::string now = store_.find(job.job_id).result_json;
  EXPECT_EQ(test::read_text(folder / "result.json"), now);
  const std::vector<ResultFile> files = read_result_json(now).files;
  EXPECT_EQ(files.at(0).state, FileState::kNotMade);
  EXPECT_NE(files.at(0).reason, "");
  EXPECT_EQ(files.at(1), result.files.at(1));
  EXPECT_EQ(std::distance(fs::directory_iterator(results_), {}), 1);
}

TEST_F(ARetention, GoesOnWithARemovalThatWasCutOff) {
  const std::string old = add(1, true, kLongAgo);
  EXPECT_TRUE(store_.results().mark_removed(old));  // and then the process was killed
  Retention retention(store_, {}, results_);
  retention.run_once();
  EXPECT_FALSE(fs::exists(results_ / old));
}

TEST_F(ARetention, NeverMarksAResultThatIsNotAcknowledged) {
  const std::string waiting = add(1, false, kLongAgo);
  EXPECT_FALSE(store_.results().mark_removed(waiting));
  EXPECT_EQ(store_.find(waiting).result_json, "{}");
}

/// No more than the disk has, in whole GiB, and more than is free; 0 where there is no such number.
int never_free_gib(const fs::path& folder) {
  const fs::space_info disk = fs::space(folder);
  const auto gib = static_cast<int>((disk.available >> 30U) + 1);
  return (disk.capacity >> 30U) >= static_cast<std::uintmax_t>(gib) ? gib : 0;
}

TEST_F(ARetention, RemovesAllThatMayGoWhereTheDiskIsNeverFreeEnough) {
  const int gib = never_free_gib(results_.parent_path());
  if (gib == 0) GTEST_SKIP() << "the disk is empty, or smaller than 1 GiB";
  const std::string old = add(1, true, kLongAgo);
  const std::string waiting = add(2, false, kLongAgo);
  Retention retention(store_, {.keep_free_gib = gib}, results_);
  retention.start();
  retention.finish();
  retention.run_once();
  EXPECT_FALSE(fs::exists(results_ / old));
  EXPECT_TRUE(fs::exists(results_ / waiting));
}

TEST_F(ARetention, SaysOnceThatTheDiskIsNotFreeEnoughThoughAllIsRemoved) {
  const int gib = never_free_gib(results_.parent_path());
  if (gib == 0) GTEST_SKIP() << "the disk is empty, or smaller than 1 GiB";
  add(1, true, kLongAgo);
  const test::CapturedLog log;
  Retention never(store_, {.keep_free_gib = gib}, results_);
  for (int i = 0; i < 2; ++i) never.run_once();
  EXPECT_EQ(log.lines_with("no acknowledged result is left to remove"), 1U) << log.text();
  Retention without(store_, {}, results_);
  without.run_once();
  EXPECT_EQ(log.lines_with("store.keep_free_gib"), 1U);
}

TEST_F(ARetention, RemovesNothingForMoreThanTheDiskHas) {
  const std::string old = add(1, true, kLongAgo);
  const test::CapturedLog log;
  Retention mistyped(store_, {.keep_free_gib = 1048576}, results_);
  for (int i = 0; i < 2; ++i) mistyped.run_once();
  EXPECT_TRUE(fs::exists(results_ / old));
  EXPECT_EQ(log.lines_with("the disk is smaller than that, and nothing is removed for it"), 1U) << log.text();
}

TEST_F(ARetention, GoesOnAtTheStartWithARemovalThatWasCutOffWhateverTheLimitsAre) {
  const std::string old = add(1, true, kLongAgo);
  const std::string kept = add(2, true, kLongAgo);
  ASSERT_TRUE(store_.results().mark_removed(old));
  Retention retention(store_, {}, results_);
  retention.start();
  const auto deadline = HostClock::now() + std::chrono::seconds(60);
  while (fs::exists(results_ / old) && HostClock::now() < deadline) std::this_thread::yield();
  retention.finish();
  EXPECT_FALSE(fs::exists(results_ / old));
  EXPECT_TRUE(fs::exists(results_ / kept));
}

TEST_F(ARetention, TakesOtherLimitsWhileItRuns) {
  const std::string old = add(1, true, kLongAgo);
  Retention retention(store_, {}, results_);
  retention.start();
  EXPECT_TRUE(fs::exists(results_ / old));
  retention.set_limits({.keep_days = 30});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (fs::exists(results_ / old)) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "it does not wait for its minute";
    std::this_thread::yield();
  }
}

}  // namespace
}  // namespace fvd
