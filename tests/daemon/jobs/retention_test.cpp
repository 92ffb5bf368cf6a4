#include "daemon/jobs/retention.hpp"

#include <filesystem>

#include <gtest/gtest.h>

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

TEST_F(ARetention, RemovesAllThatMayGoWhereTheDiskIsNeverFreeEnough) {
  const std::string old = add(1, true, kLongAgo);
  const std::string waiting = add(2, false, kLongAgo);
  Retention retention(store_, {.keep_free_gib = 1048576}, results_);
  retention.start();
  retention.finish();
  retention.run_once();
  EXPECT_FALSE(fs::exists(results_ / old));
  EXPECT_TRUE(fs::exists(results_ / waiting));
}

}  // namespace
}  // namespace fvd
