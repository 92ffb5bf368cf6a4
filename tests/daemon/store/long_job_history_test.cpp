/// Lists of a hundred thousand jobs: how much of them one answer looks at, and how they are read.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/store/job_history.hpp"
#include "tests/daemon/store/job_history_fixture.hpp"

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

TEST_F(AJobHistory, FindsItsWayThroughAHundredThousandJobs) {
  fill({kManyJobs, kTheirValues});

  EXPECT_THAT(numbers({}, 3), ElementsAre(100000, 99999, 99998));
  EXPECT_THAT(numbers({.recipe = "rare"}, 2), ElementsAre(100000, 99900));
  EXPECT_THAT(numbers({.text = "frames_lost"}, 2), ElementsAre(99993, 99983));
  EXPECT_THAT(numbers({.part_id = "P-999", .recipe = "often"}, 2), ElementsAre(99999, 98999));
  EXPECT_THAT(all_numbers({.text = "nowhere"}), IsEmpty());
  EXPECT_THAT(all_numbers({.from_utc = "2023-11-14T22:13:00.000Z", .to_utc = "2023-11-14T22:16:00.000Z"}),
              ElementsAre(2, 1));
  EXPECT_THAT(all_numbers({.state = JobState::kFailed}), SizeIs(10000));
}

TEST_F(AJobHistory, LooksAtTwentyThousandJobsAtATimeAndSaysSo) {
  fill({kManyJobs, kTheirValues});
  std::int64_t before = 0;
  int parts = 0;
  do {
    const JobPage page = store_->history().page({.text = "nowhere"}, before, 3);
    EXPECT_THAT(page.jobs, IsEmpty());
    before = page.next;
    ++parts;
  } while (before != 0 && parts < 10);
  EXPECT_EQ(parts, 5) << "the last of them says that it is";

  const JobPage last_of_it = store_->history().page({.recipe = "rare"}, 80101, 1);
  ASSERT_THAT(last_of_it.jobs, SizeIs(1));
  EXPECT_EQ(last_of_it.jobs[0].request.seq, 80100);
  EXPECT_THAT(all_numbers({.recipe = "rare"}), SizeIs(1000)) << "none twice, none left out";

  const ValueList rare = store_->history().values({"step", "height_um", "rare", 2000});
  ASSERT_THAT(rare.points, SizeIs(200));
  EXPECT_EQ(rare.points.front().value.value, 80100.0);
  EXPECT_EQ(rare.points.back().value.value, 100000.0);
  EXPECT_FALSE(rare.searched_all);
  EXPECT_TRUE(store_->history().values({"step", "height_um", "rare", 200}).searched_all) << "as many as were asked for";
  EXPECT_FALSE(store_->history().values({"step", "width_um", "", 2}).searched_all);
  fill({"DELETE FROM jobs WHERE number % 5 <> 0"});
  EXPECT_EQ(store_->history().page({.text = "nowhere"}, 0, 3).next, 0) << "numbers that are gone are no jobs";
  const ValueList all = store_->history().values({"step", "height_um", "rare", 2000});
  EXPECT_THAT(all.points, SizeIs(1000));
  EXPECT_TRUE(all.searched_all);
}

TEST_F(AJobHistory, IsReadFromItsIndexAloneInTheOrderInWhichItIsTold) {
  fill({kManyJobs, "ANALYZE"});
  const std::string page = plan_of(JobHistory::page_sql());
  EXPECT_THAT(page, HasSubstr("COVERING INDEX jobs_history (number>? AND number<?)"));
  EXPECT_THAT(page, Not(HasSubstr("TEMP B-TREE"))) << "the first part does not wait for the last";
  EXPECT_THAT(page, Not(HasSubstr("PRIMARY KEY")));
}

TEST_F(AJobHistory, ReadsAValueOfEachJobInOneLook) {
  const std::string plan = plan_of(JobHistory::values_sql());
  EXPECT_THAT(plan, AllOf(HasSubstr("jobs USING COVERING INDEX jobs_history"), Not(HasSubstr("TEMP B-TREE"))));
  EXPECT_THAT(plan, HasSubstr("SEARCH job_values USING PRIMARY KEY (number=? AND measurement=? AND name=?)"));
}

}  // namespace
}  // namespace fvd
