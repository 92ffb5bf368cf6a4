/// Jobs and values in lists: order, parts, filters, ends that are not stored yet.

#include "daemon/store/job_history.hpp"

#include <cerrno>
#include <future>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/store/job_store.hpp"
#include "daemon/store/migrations.hpp"
#include "tests/daemon/store/broken_disk.hpp"
#include "tests/daemon/store/held_disk.hpp"
#include "tests/daemon/store/job_history_fixture.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(AJobHistory, HasNothingAtFirst) {
  const JobPage page = store_->history().page({}, 0, 50);
  EXPECT_THAT(page.jobs, IsEmpty());
  EXPECT_EQ(page.next, 0);
  EXPECT_THAT(heights(), IsEmpty());
}

TEST_F(AJobHistory, TellsTheNewestFirstWithAllThatAListShows) {
  const JobStatus old = accept(7, "A \"quoted\" part", "groove", "fvdctl");
  finish(old, "uncertain", "2026-11-30T10:00:00.000Z");
  JobStatus failed = accept(9);
  failed.state = JobState::kFailed;
  failed.error = ErrorCode::kCameraFramesLost;
  failed.ended_utc = "2026-11-30T11:00:00.000Z";
  store_->finish(failed, "", "");
  const JobStatus running = accept(8);

  const auto jobs = store_->history().page({}, 0, 50).jobs;

  ASSERT_THAT(jobs, SizeIs(3));
  EXPECT_EQ(jobs[0].job_id, running.job_id);
  EXPECT_EQ(jobs[0].state, JobState::kProcessing);
  EXPECT_EQ(jobs[0].ended_utc, "");
  EXPECT_EQ(jobs[1].state, JobState::kFailed);
  EXPECT_EQ(jobs[1].error, ErrorCode::kCameraFramesLost);
  EXPECT_EQ(jobs[1].verdict, "");
  EXPECT_EQ(jobs[2].job_id, old.job_id);
  EXPECT_EQ(jobs[2].request.seq, 7);
  EXPECT_EQ(jobs[2].request.client, "fvdctl");
  EXPECT_EQ(jobs[2].request.part_id, "A \"quoted\" part");
  EXPECT_EQ(jobs[2].request.recipe, "groove");
  EXPECT_EQ(jobs[2].state, JobState::kCompleted);
  EXPECT_EQ(jobs[2].verdict, "uncertain");
  EXPECT_EQ(jobs[2].ended_utc, "2026-11-30T10:00:00.000Z");
  EXPECT_EQ(jobs[2].error, std::nullopt);
}

TEST_F(AJobHistory, IsReadInPartsThatHoldEachJobOnceWhateverComesMeanwhile) {
  for (int seq = 1; seq <= 10; ++seq) finish(accept(seq));

  std::vector<std::int64_t> seen;
  std::int64_t before = 0;
  int parts = 0;
  do {
    const JobPage page = store_->history().page({}, before, 3);
    EXPECT_LE(page.jobs.size(), 3U);
    for (const JobStatus& job : page.jobs) seen.push_back(job.request.seq);
    before = page.next;
    finish(accept(11 + parts++));
  } while (before != 0);

  EXPECT_THAT(seen, ElementsAre(10, 9, 8, 7, 6, 5, 4, 3, 2, 1));
  EXPECT_EQ(parts, 4);
  EXPECT_EQ(store_->history().page({}, 0, 14).next, 0) << "all of them in one";
  EXPECT_NE(store_->history().page({}, 0, 13).next, 0);
  EXPECT_THAT(store_->history().page({}, 1, 3).jobs, IsEmpty()) << "before the first";
  EXPECT_THAT(store_->history().page({}, std::numeric_limits<std::int64_t>::max(), 3).jobs, SizeIs(3));
}

TEST_F(AJobHistory, LeavesOutWhatDoesNotFit) {
  finish(accept(1, "P-1", "groove"), "pass", "2026-11-30T10:00:00.000Z");
  finish(accept(2, "P-12", "groove"), "fail", "2026-11-30T11:00:00.000Z");
  finish(accept(3, "Q-1", "edge", "cell-7"), "", "2026-11-30T12:00:00.000Z");
  JobStatus lost = accept(4, "p-1", "edge");
  lost.state = JobState::kAborted;
  lost.error = ErrorCode::kStageDisconnected;
  lost.ended_utc = "2026-11-30T13:00:00.000Z";
  store_->finish(lost, "", "");
  (void)accept(5, "P-1", "edge");

  EXPECT_THAT(numbers({.part_id = "P-1"}), ElementsAre(5, 2, 1));
  EXPECT_THAT(numbers({.part_id = "P-12"}), ElementsAre(2));
  EXPECT_THAT(numbers({.part_id = "-1"}), IsEmpty()) << "ids begin so";
  EXPECT_THAT(numbers({.recipe = "edge"}), ElementsAre(5, 4, 3));
  EXPECT_THAT(numbers({.recipe = "edg"}), IsEmpty());
  EXPECT_THAT(numbers({.verdict = "fail"}), ElementsAre(2));
  EXPECT_THAT(numbers({.verdict = ""}), ElementsAre(5, 4, 3)) << "nothing was judged";
  EXPECT_THAT(numbers({.state = JobState::kCompleted}), ElementsAre(3, 2, 1));
  EXPECT_THAT(numbers({.state = JobState::kProcessing}), ElementsAre(5));
  EXPECT_THAT(numbers({.from_utc = "2026-11-30T11:00:00.000Z"}), ElementsAre(4, 3, 2))
      << "of the running one nobody knows";
  EXPECT_THAT(numbers({.to_utc = "2026-11-30T11:00:00.000Z"}), ElementsAre(2, 1));
  EXPECT_THAT(numbers({.from_utc = "2026-11-30T11:00:00.001Z", .to_utc = "2026-11-30T12:59:59.999Z"}), ElementsAre(3));
  EXPECT_THAT(numbers({.from_utc = "2027-01-01T00:00:00.000Z", .to_utc = "2026-01-01T00:00:00.000Z"}), IsEmpty());
  EXPECT_THAT(numbers({.text = "STAGE_dis"}), ElementsAre(4)) << "the error";
  EXPECT_THAT(numbers({.text = "CELL"}), ElementsAre(3)) << "the client";
  EXPECT_THAT(numbers({.text = "groo"}), ElementsAre(2, 1));
  EXPECT_THAT(numbers({.text = "p-1"}), ElementsAre(5, 4, 2, 1)) << "capital letters or not";
  EXPECT_THAT(numbers({.text = lost.job_id.substr(4)}), ElementsAre(4));
  EXPECT_THAT(numbers({.text = "1groove"}), IsEmpty()) << "keys do not run into one another";
  EXPECT_THAT(numbers({.part_id = "P",
                       .recipe = "groove",
                       .verdict = "pass",
                       .state = JobState::kCompleted,
                       .from_utc = "2026-11-30T09:00:00.000Z",
                       .to_utc = "2026-11-30T10:00:00.000Z",
                       .text = "plc"}),
              ElementsAre(1));
}

TEST_F(AJobHistory, TakesWhatIsSoughtAsItStands) {
  std::int64_t seq = 0;
  for (const char* part : {"50%", "50_", "50x", "a'b", "*", "\"; DROP TABLE jobs; --"}) finish(accept(++seq, part));
  for (const char* part : {"50%", "50_", "a'b", "*", "\"; DROP TABLE jobs; --"}) {
    for (const JobFilter& filter : {JobFilter{.part_id = part}, JobFilter{.text = part}}) {
      const auto jobs = store_->history().page(filter, 0, 50).jobs;
      ASSERT_THAT(jobs, SizeIs(1)) << part;
      EXPECT_EQ(jobs[0].request.part_id, part);
    }
  }
  for (const std::string& nothing :
       {std::string("\0", 1), std::string("%"), std::string("\xff"), std::string("\xc3\xa4")}) {
    EXPECT_THAT(numbers({.recipe = nothing}), IsEmpty());
  }
}

TEST_F(AJobHistory, TellsAnEndThatIsNotStoredYetWhereItFits) {
  finish(accept(1));
  const JobStatus job = accept(2, "part-2");
  JobStatus ended = job;
  ended.state = JobState::kFailed;
  ended.error = ErrorCode::kStageAlarm;
  ended.verdict = "invalid";
  ended.ended_utc = "2026-11-30T10:00:00.000Z";
  {
    const test::BrokenDisk broken(EIO);
    FVD_EXPECT_ERROR(kDatabase, store_->finish(ended, "dir", "{}", false, {height_of(50)}));
  }

  EXPECT_EQ(store_->history().page({}, 0, 1).jobs.at(0).state, JobState::kFailed);
  EXPECT_THAT(numbers({}), ElementsAre(2, 1));
  EXPECT_THAT(numbers({.state = JobState::kProcessing}), IsEmpty()) << "as its row still has it";
  EXPECT_THAT(numbers({.state = JobState::kFailed}), ElementsAre(2));
  EXPECT_THAT(numbers({.verdict = "invalid"}), ElementsAre(2));
  EXPECT_THAT(numbers({.text = "stage_alarm"}), ElementsAre(2));
  EXPECT_THAT(numbers({.to_utc = "2026-11-30T10:00:00.000Z"}), ElementsAre(2));
  EXPECT_THAT(numbers({.recipe = "x"}), IsEmpty());
  EXPECT_THAT(store_->history().page({.state = JobState::kFailed}, 2, 5).jobs, IsEmpty()) << "behind it in the list";
  const JobPage first = store_->history().page({.state = JobState::kCompleted}, 0, 1);
  EXPECT_THAT(first.jobs, SizeIs(1));
  EXPECT_EQ(first.next, 0) << "the one that does not fit is no next part";
  EXPECT_THAT(heights(), IsEmpty()) << "values come with the row";

  store_->store_kept_ends();

  EXPECT_THAT(numbers({.state = JobState::kFailed}), ElementsAre(2));
  EXPECT_THAT(heights(), SizeIs(1));
}

TEST_F(AJobHistory, KeepsTheValuesThatCameWithAJobsEnd) {
  finish(accept(1, "a"), "pass", "2026-11-30T10:00:00.000Z",
         {height_of(50.1), {"map", "sigma_median", 0.3, {}, {}, {}, {}, ""}});
  finish(accept(2, "b"), "invalid", "2026-11-30T11:00:00.000Z", {{"step", "height_um", {}, {}, {}, {}, {}, "invalid"}});
  finish(accept(3, "c", "other"), "pass", "2026-11-30T12:00:00.000Z", {height_of(-1e-9)});
  finish(accept(4, "d"));
  store_ = nullptr;
  store_ = std::make_unique<JobStore>(file_);

  const auto points = heights();

  ASSERT_THAT(points, SizeIs(3));
  EXPECT_EQ(points[0].part_id, "a") << "the oldest first";
  EXPECT_EQ(points[0].job_id, store_->find(ClientSeq{1}).status.job_id);
  EXPECT_EQ(points[0].ended_utc, "2026-11-30T10:00:00.000Z");
  EXPECT_EQ(points[0].value, height_of(50.1));
  EXPECT_EQ(points[1].value, (StoredValue{"step", "height_um", {}, {}, {}, {}, {}, "invalid"}));
  EXPECT_EQ(points[2].value.value, -1e-9);
  EXPECT_THAT(heights("chapter"), SizeIs(2));
  EXPECT_THAT(heights("nothing"), IsEmpty());
  const auto newest = heights("", 2);
  ASSERT_THAT(newest, SizeIs(2)) << "of the newest jobs";
  EXPECT_EQ(newest[0].part_id, "b");
  EXPECT_EQ(newest[1].part_id, "c");
  EXPECT_THAT(store_->history().values({"map", "sigma_median"}).points, SizeIs(1));
  EXPECT_THAT(store_->history().values({"step", "width_um"}).points, IsEmpty());
}

TEST_F(AJobHistory, KeepsOfAJobThatEndsAgainTheValuesOfItsLastEnd) {
  const JobStatus job = accept(1);
  finish(job, "pass", "", {height_of(1), {"step", "width_um", 2.0, {}, {}, {}, {}, ""}});
  finish(job, "pass", "", {height_of(3)});
  ASSERT_THAT(heights(), SizeIs(1));
  EXPECT_EQ(heights()[0].value.value, 3.0);
  EXPECT_THAT(store_->history().values({"step", "width_um"}).points, IsEmpty());
}

TEST_F(AJobHistory, TakesTheFirstOfTwoValuesOfOneNameAndNoNumberThatIsNone) {
  StoredValue strange = height_of(std::numeric_limits<double>::infinity());
  strange.u = std::numeric_limits<double>::quiet_NaN();
  strange.lower = -std::numeric_limits<double>::infinity();
  finish(accept(1), "pass", "", {strange, height_of(5)});
  ASSERT_THAT(heights(), SizeIs(1));
  EXPECT_EQ(heights()[0].value.value, std::nullopt);
  EXPECT_EQ(heights()[0].value.u, std::nullopt);
  EXPECT_EQ(heights()[0].value.lower, std::nullopt);
  EXPECT_EQ(heights()[0].value.expanded_u, 0.02);
}

TEST(AJobsEnd, IsStoredWithItsValuesOrNotAtAll) {
  bool failed = true;
  int failures = 0;
  for (int good_writes = 0; failed; ++good_writes) {
    ASSERT_LT(good_writes, 200);
    const test::ScratchDir folder;
    {
      JobStore store(folder / "fvd.sqlite");
      JobStatus job = store.accept({1, "part", "chapter"});
      job.state = JobState::kCompleted;
      const test::BrokenDisk broken(EIO, good_writes);
      try {
        store.finish(job, "dir", "{}", false, {height_of(50)});
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kDatabase) << error.what();
      }
      failed = broken.has_failed();
    }
    failures += failed ? 1 : 0;
    const Database database(folder / "fvd.sqlite");
    Statement row(database, "SELECT state, (SELECT count(*) FROM job_values) FROM jobs");
    ASSERT_TRUE(row.step());
    EXPECT_EQ(row.integer(1), row.text(0) == "completed" ? 1 : 0) << "after " << good_writes << " writes";
    EXPECT_TRUE(failed || row.text(0) == "completed");
  }
  EXPECT_GT(failures, 1) << "an end is more than one write";
}

TEST_F(AJobHistory, LosesAJobsValuesWithItsRow) {
  finish(accept(1), "pass", "", {height_of(1)});
  finish(accept(2), "pass", "", {height_of(2)});
  fill({"DELETE FROM jobs WHERE number = 1"});
  ASSERT_THAT(heights(), SizeIs(1));
  EXPECT_EQ(heights()[0].value.value, 2.0);
  fill({"DELETE FROM jobs"});
  store_.reset();
  const Database database(file_);
  Statement left(database, "SELECT count(*) FROM job_values");
  ASSERT_TRUE(left.step());
  EXPECT_EQ(left.integer(0), 0);
}

TEST_F(AJobHistory, KeepsNobodyWaitingAndWaitsForNoCommit) {
  finish(accept(1));
  const JobStatus job = accept(2);
  test::HeldDisk disk;
  std::jthread commit([&] { finish(job); });
  disk.await_a_write();

  const auto read = std::async(std::launch::async, [this] {
    EXPECT_THAT(numbers({.state = JobState::kCompleted}), ElementsAre(1));
    EXPECT_THAT(heights(), IsEmpty());
  });
  EXPECT_EQ(read.wait_for(std::chrono::seconds(5)), std::future_status::ready);
  disk.let_go();
  commit.join();
  read.wait();
}

TEST(AFileOfVersion12, HasItsJobsInTheListAndNoValues) {
  const test::ScratchDir folder;
  const auto file = folder / "fvd.sqlite";
  {
    Database database(file);
    migrate(database, 12);
    database.execute(
        "INSERT INTO jobs (job_id, seq, part_id, recipe, state, verdict, ended_utc, result_json) VALUES "
        "('J1', 1, 'p', 'r', 'completed', 'pass', '2026-11-30T10:00:00.000Z', '{\"verdict\": \"pass\"}')");
  }
  const JobStore store(file);
  const auto jobs = store.history().page({}, 0, 10).jobs;
  ASSERT_THAT(jobs, SizeIs(1));
  EXPECT_EQ(jobs[0].job_id, "J1");
  EXPECT_EQ(jobs[0].verdict, "pass");
  EXPECT_THAT(store.history().values({"map", "height_mean"}).points, IsEmpty());
  EXPECT_TRUE(std::filesystem::exists(folder / "fvd.sqlite.v12"));
}

}  // namespace
}  // namespace fvd
