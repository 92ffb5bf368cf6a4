#include "daemon/store/job_store.hpp"

#include <chrono>
#include <future>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/store/database.hpp"
#include "tests/daemon/store/held_disk.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {

/// For the names of the tests.
static void PrintTo(JobState state, std::ostream* out) { *out << job_state_name(state); }

namespace {

JobRequest request(std::int64_t seq, const std::string& part = "part", const std::string& recipe = "chapter") {
  return {seq, part, recipe};
}

class AJobStore : public ::testing::Test {
 protected:
  /// As a new process would see it.
  void reopen() {
    store_.reset();
    store_ = std::make_unique<JobStore>(file_);
  }
  void finish(JobStatus job, JobState state = JobState::kCompleted) {
    job.state = state;
    store_->finish(job, "/results/" + job.job_id, "{}");
  }

  test::ScratchDir folder_;
  std::filesystem::path file_ = folder_.path() / "state" / "jobs.db";
  std::unique_ptr<JobStore> store_ = std::make_unique<JobStore>(file_);
};

TEST_F(AJobStore, CreatesItsFolder) { EXPECT_TRUE(std::filesystem::exists(file_)); }

TEST_F(AJobStore, KnowsNothingAtFirst) {
  EXPECT_FALSE(store_->latest());
  EXPECT_FALSE(store_->next_unacknowledged());
  EXPECT_EQ(store_->unacknowledged_count(), 0);
  EXPECT_FALSE(store_->find_repeated(request(1)));
  FVD_EXPECT_ERROR(kUnknownJob, (void)store_->find(ClientSeq{1}));
  FVD_EXPECT_ERROR(kUnknownJob, (void)store_->find(std::string("x")));
  FVD_EXPECT_ERROR(kUnknownJob, store_->acknowledge(std::string("x")));
}

TEST_F(AJobStore, WritesItsLogAnewWhenItIsShortened) {
  const std::filesystem::path log = file_.string() + "-wal";
  const auto measure = [this](int first, int last) {
    for (int seq = first; seq < last; ++seq) {
      const JobStatus job = store_->accept(request(seq));
      finish(job);
      store_->shorten_log();
      store_->note_files(job.job_id, "{}", false);
    }
  };
  measure(1, 10);
  const auto size_bytes = std::filesystem::file_size(log);
  measure(10, 60);
  EXPECT_LE(std::filesystem::file_size(log), size_bytes + size_bytes / 2);
  EXPECT_EQ(store_->find(ClientSeq{59}).status.state, JobState::kCompleted);
}

TEST_F(AJobStore, WritesThePreparedRecipeOnlyWhereItIsAnother) {
  const auto written_for = [this](std::int64_t seq, const std::string& recipe) {
    const std::filesystem::path log = file_.string() + "-wal";
    const auto before = std::filesystem::file_size(log);
    (void)store_->accept(request(seq, "part", recipe));
    return std::filesystem::file_size(log) - before;
  };
  (void)written_for(1, "chapter");
  const auto for_the_same = written_for(2, "chapter");
  EXPECT_EQ(written_for(3, "groove"), for_the_same + 24 + 4096) << "a page, and its head in the log";
  EXPECT_EQ(store_->prepared_recipe(), "groove");
  reopen();
  EXPECT_EQ(store_->prepared_recipe(), "groove");
}

TEST_F(AJobStore, KeepsTheTemperatureThatCameWithAJob) {
  JobRequest warm = request(1);
  warm.temperature_c = 20.1;  // no binary fraction: it must come back as it went
  store_->accept(warm);
  store_->accept(request(2));
  JobRequest zero = request(3);
  zero.temperature_c = 0.0;
  store_->accept(zero);

  reopen();

  EXPECT_EQ(store_->find(ClientSeq{1}).status.request.temperature_c, 20.1);
  EXPECT_EQ(store_->find(ClientSeq{2}).status.request.temperature_c, std::nullopt);
  EXPECT_EQ(store_->find(ClientSeq{3}).status.request.temperature_c, 0.0) << "which is not none";
}

TEST_F(AJobStore, TakesAnotherTemperatureForAnotherRequest) {
  JobRequest warm = request(1);
  warm.temperature_c = 20.1;
  const JobStatus first = store_->accept(warm);
  store_->accept(request(2));

  EXPECT_EQ(store_->find_repeated(warm)->job_id, first.job_id);
  JobRequest warmer = warm;
  warmer.temperature_c = 20.2;
  FVD_EXPECT_ERROR_SAYING(kSeqConflict, (void)store_->find_repeated(warmer), testing::HasSubstr("temperature_c 20.1"));
  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->find_repeated(request(1)));
  JobRequest late = request(2);
  late.temperature_c = 20.1;
  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->find_repeated(late));
}

TEST_F(AJobStore, KeepsTheObjectiveThatWasConfirmedLast) {
  EXPECT_FALSE(store_->objectives().latest().has_value());
  store_->objectives().add("20x", "Anna");
  const ObjectiveConfirmation second = store_->objectives().add("50x", "Bert");

  reopen();

  const auto latest = store_->objectives().latest();
  ASSERT_TRUE(latest.has_value());
  EXPECT_EQ(latest->objective, "50x");
  EXPECT_EQ(latest->person, "Bert");
  EXPECT_EQ(latest->confirmed_utc, second.confirmed_utc);
}

TEST_F(AJobStore, CountsItsOpenings) {
  EXPECT_EQ(store_->epoch(), 1);
  reopen();
  EXPECT_EQ(store_->epoch(), 2);
}

TEST_F(AJobStore, FindsAnAcceptedJobByIdAndBySeq) {
  const JobStatus job = store_->accept(request(7, "A-17"));

  EXPECT_EQ(job.state, JobState::kProcessing);
  EXPECT_EQ(store_->find(job.job_id).status.request.seq, 7);
  EXPECT_EQ(store_->find(ClientSeq{7}).status.job_id, job.job_id);
  EXPECT_EQ(store_->find(ClientSeq{7}).status.request.part_id, "A-17");
  EXPECT_EQ(store_->latest()->job_id, job.job_id);
}

TEST_F(AJobStore, GivesIdsThatAreUniqueSortableAndShort) {
  std::vector<std::string> ids;
  for (int seq = 1; seq <= 60; ++seq) {
    if (seq % 20 == 0) reopen();
    ids.push_back(store_->accept(request(seq)).job_id);
  }

  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
  EXPECT_THAT(ids, ::testing::WhenSorted(::testing::ElementsAreArray(ids)));
  EXPECT_THAT(ids, ::testing::Each(::testing::SizeIs(::testing::Le(32))));
  EXPECT_THAT(ids, ::testing::Each(::testing::MatchesRegex("[0-9]+T[0-9]+Z-[0-9]+-[0-9]+")));
}

TEST_F(AJobStore, ReturnsTheSameJobForARepeatedRequest) {
  const JobStatus job = store_->accept(request(7));

  EXPECT_EQ(store_->find_repeated(request(7)).value().job_id, job.job_id);
  EXPECT_EQ(store_->find_repeated(request(7, "part", "")).value().job_id, job.job_id) << "the recipe was left open";
  reopen();
  EXPECT_EQ(store_->find_repeated(request(7)).value().job_id, job.job_id);
}

TEST_F(AJobStore, RefusesANumberThatBelongsToAnotherRequest) {
  (void)store_->accept(request(7));

  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->find_repeated(request(7, "another part")));
  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->find_repeated(request(7, "part", "another recipe")));
  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->accept(request(7)));
  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->accept(request(7, "another part")));
}

TEST_F(AJobStore, KeepsTheNumbersOfEveryClientApart) {
  const JobStatus plc = store_->accept(request(7));
  const JobStatus other = store_->accept({7, "another part", "fine", "fvdctl"});

  EXPECT_NE(other.job_id, plc.job_id);
  EXPECT_EQ(store_->find(ClientSeq{7}).status.job_id, plc.job_id);
  EXPECT_EQ(store_->find(ClientSeq{7, "fvdctl"}).status.job_id, other.job_id);
  EXPECT_EQ(store_->find_repeated({7, "another part", "fine", "fvdctl"}).value().job_id, other.job_id);
  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->find_repeated({7, "part", "chapter", "fvdctl"}));
  FVD_EXPECT_ERROR(kUnknownJob, (void)store_->find(ClientSeq{7, "nobody"}));
  finish(other);
  EXPECT_EQ(store_->acknowledge(ClientSeq{7, "fvdctl"}), 0);
  reopen();
  EXPECT_EQ(store_->find(ClientSeq{7, "fvdctl"}).status.request.client, "fvdctl");
}

TEST_F(AJobStore, LooksBackFromEachClientsOwnHighestNumber) {
  (void)store_->accept({1'000'000, "part", "chapter", "fvdctl"});

  EXPECT_NO_THROW((void)store_->accept(request(1)));
  FVD_EXPECT_ERROR(kSeqStale, (void)store_->accept({1, "part", "chapter", "fvdctl"}));
  EXPECT_EQ(store_->highest("fvdctl")->request.seq, 1'000'000);
  EXPECT_EQ(store_->highest(kDefaultClient)->request.seq, 1);
  EXPECT_FALSE(store_->highest("nobody"));
}

TEST_F(AJobStore, RefusesUnknownNumbersBehindTheWindow) {
  (void)store_->accept(request(1));
  (void)store_->accept(request(5000));

  EXPECT_FALSE(store_->find_repeated(request(5000 - kSeqWindow))) << "the last number of the window is new";
  FVD_EXPECT_ERROR(kSeqStale, (void)store_->find_repeated(request(4999 - kSeqWindow)));
  FVD_EXPECT_ERROR(kSeqStale, (void)store_->accept(request(4999 - kSeqWindow)));
  EXPECT_TRUE(store_->find_repeated(request(1))) << "known, however old";
}

TEST_F(AJobStore, KeepsTheLargestSequenceNumber) {
  constexpr std::int64_t kLargest = (std::int64_t{1} << 53U) - 1;
  const JobStatus job = store_->accept(request(kLargest));
  EXPECT_EQ(store_->find(ClientSeq{kLargest}).status.job_id, job.job_id);
}

TEST_F(AJobStore, KeepsEverythingOfAnEndedJob) {
  JobStatus job = store_->accept(request(7, "A \"quoted\" part"));
  job.state = JobState::kFailed;
  job.error = ErrorCode::kCameraFramesLost;
  job.error_message = "slice 3 was lost\nthree times: \xc2\xb5m";
  job.slices_done = 3;
  job.slices_planned = 21;
  job.frames = {.expected = 6, .ok = 1, .incomplete = 2, .missing = 1, .stale = 1, .underrun = 1};

  job.acquired = true;
  store_->finish(job, "/results/x", "{\"a\":1}");
  reopen();

  const StoredJob stored = store_->find(job.job_id);
  EXPECT_EQ(stored.status.request.part_id, "A \"quoted\" part");
  EXPECT_EQ(stored.status.request.recipe, "chapter");
  EXPECT_EQ(stored.status.state, JobState::kFailed);
  EXPECT_EQ(stored.status.error, ErrorCode::kCameraFramesLost);
  EXPECT_EQ(stored.status.error_message, job.error_message);
  EXPECT_EQ(stored.status.slices_done, 3);
  EXPECT_EQ(stored.status.slices_planned, 21);
  EXPECT_EQ(stored.status.frames, job.frames);
  EXPECT_TRUE(stored.status.acquired);
  EXPECT_EQ(stored.result_dir, "/results/x");
  EXPECT_EQ(stored.result_json, "{\"a\":1}");
}

class EveryJobState : public AJobStore, public ::testing::WithParamInterface<JobState> {};

TEST_P(EveryJobState, SurvivesReopening) {
  const JobStatus job = store_->accept(request(1));
  finish(job, GetParam());
  reopen();
  EXPECT_EQ(store_->find(job.job_id).status.state, GetParam());
  EXPECT_EQ(store_->find(job.job_id).status.error, std::nullopt);
}
INSTANTIATE_TEST_SUITE_P(Ended, EveryJobState,
                         ::testing::Values(JobState::kCompleted, JobState::kAborted, JobState::kFailed),
                         [](const auto& of) { return std::string(job_state_name(of.param)); });

TEST_F(AJobStore, KeepsEveryErrorCode) {
  for (int code = 0; code <= static_cast<int>(kLastErrorCode); ++code) {
    JobStatus job = store_->accept(request(code + 1));
    job.error = static_cast<ErrorCode>(code);
    job.state = JobState::kFailed;
    store_->finish(job, "", "");
    EXPECT_EQ(store_->find(job.job_id).status.error, job.error) << error_name(*job.error);
  }
}

TEST_F(AJobStore, RefusesToFinishAJobItDoesNotKnow) {
  JobStatus job;
  job.job_id = "never accepted";
  job.state = JobState::kCompleted;
  FVD_EXPECT_ERROR(kUnknownJob, store_->finish(job, "", ""));
}

TEST_F(AJobStore, HandsOutUnacknowledgedJobsOldestFirst) {
  const JobStatus first = store_->accept(request(10));
  const JobStatus second = store_->accept(request(5));
  EXPECT_FALSE(store_->next_unacknowledged()) << "running jobs are not handed out";

  finish(second, JobState::kFailed);
  EXPECT_EQ(store_->next_unacknowledged()->job_id, second.job_id);
  finish(first);
  EXPECT_EQ(store_->next_unacknowledged()->job_id, first.job_id);
  EXPECT_EQ(store_->unacknowledged_count(), 2);

  EXPECT_EQ(store_->acknowledge(first.job_id), 1);
  EXPECT_EQ(store_->acknowledge(first.job_id), 1) << "repeating changes nothing";
  EXPECT_TRUE(store_->find(first.job_id).status.acknowledged);
  EXPECT_EQ(store_->next_unacknowledged()->job_id, second.job_id);
  EXPECT_EQ(store_->acknowledge(ClientSeq{5}), 0);
  EXPECT_FALSE(store_->next_unacknowledged());
}

TEST_F(AJobStore, CountsEndedJobsOnceHoweverOftenTheyEnd) {
  const JobStatus job = store_->accept(request(1));
  (void)store_->accept(request(2));
  finish(job, JobState::kFailed);
  finish(job, JobState::kCompleted);
  EXPECT_EQ(store_->unacknowledged_count(), 1);
  reopen();
  EXPECT_EQ(store_->unacknowledged_count(), 2) << "the one that was running was ended";
}

TEST_F(AJobStore, CountsAHundredThousandResultsWithoutReadingThem) {
  store_.reset();
  Database(file_).execute(
      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 100000) "
      "INSERT INTO jobs (job_id, seq, part_id, recipe, state) SELECT 'job-' || i, i, 'p', 'r', 'completed' FROM n");
  store_ = std::make_unique<JobStore>(file_);

  const auto begin = std::chrono::steady_clock::now();
  for (int call = 0; call < 1000; ++call) EXPECT_EQ(store_->unacknowledged_count(), 100000);
  // Counting the rows takes milliseconds a call.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
  EXPECT_EQ(store_->acknowledge(ClientSeq{500}), 99999);
}

TEST_F(AJobStore, RefusesToAcknowledgeARunningJob) {
  const JobStatus job = store_->accept(request(1));
  FVD_EXPECT_ERROR(kBusy, store_->acknowledge(job.job_id));
}

TEST_F(AJobStore, KeepsNoReaderWaitingForACommit) {
  const JobStatus job = store_->accept(request(1));
  (void)store_->recipe_versions().add({.id = "a", .text = "one"}, 10);
  test::HeldDisk disk;
  std::jthread commit([&] { finish(job); });
  disk.await_a_write();

  const auto read = std::async(std::launch::async, [this] {
    EXPECT_EQ(store_->find(ClientSeq{1}).status.state, JobState::kProcessing) << "not durable yet";
    EXPECT_TRUE(store_->find_repeated(request(1)).has_value());
    EXPECT_TRUE(store_->latest().has_value());
    EXPECT_FALSE(store_->next_unacknowledged().has_value());
    EXPECT_EQ(store_->recipe_versions().latest("a").value().text, "one");
  });
  EXPECT_EQ(read.wait_for(std::chrono::seconds(5)), std::future_status::ready);

  disk.let_go();
  commit.join();
  read.wait();
  EXPECT_EQ(store_->find(ClientSeq{1}).status.state, JobState::kCompleted);
}

TEST_F(AJobStore, TakesJobsFromSeveralThreads) {
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([this, thread] {
        for (int i = 0; i < 25; ++i) finish(store_->accept(request(1 + thread * 25 + i)));
      });
    }
  }
  EXPECT_EQ(store_->unacknowledged_count(), 100);
}

}  // namespace
}  // namespace fvd
