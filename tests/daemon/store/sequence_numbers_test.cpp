/// What numbers a client may use, and what becomes of them when the database is lost or put back.

#include "daemon/store/sequence_numbers.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/store/database_copy.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/store/store_marker.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

class SequenceNumbers : public ::testing::Test {
 protected:
  void open(const JobStore::Options& options = {}) {
    store_.reset();
    store_ = std::make_unique<JobStore>(file_, options);
  }
  void end(std::int64_t seq, const std::string& ended_utc = {}) {
    JobStatus job = store_->accept({seq, "part", "chapter"});
    job.state = JobState::kCompleted;
    job.ended_utc = ended_utc;
    store_->finish(job, "dir", "{}");
  }
  [[nodiscard]] std::int64_t newest() const {
    const auto all = store_->newest_seqs();
    const auto found = all->find(kDefaultClient);
    return found == all->end() ? 0 : found->second;
  }

  test::ScratchDir folder_;
  fs::path file_ = folder_.path() / "fvd.sqlite";
  std::unique_ptr<JobStore> store_ = std::make_unique<JobStore>(file_);
};

TEST_F(SequenceNumbers, TellTheNewestOfEachClientAlsoAfterARestart) {
  EXPECT_EQ(newest(), 0);
  end(7);
  end(5);
  (void)store_->accept({900, "part", "chapter", "fvdctl"});
  EXPECT_EQ(newest(), 7);
  EXPECT_EQ(store_->newest_seqs()->at("fvdctl"), 900);
  open();
  EXPECT_EQ(newest(), 7);
}

TEST_F(SequenceNumbers, MayNotJumpByMoreThanTenThousand) {
  end(1'000'000);  // the first may be any
  FVD_EXPECT_ERROR_SAYING(kSeqStale, (void)store_->accept({1'010'001, "part", "chapter"}),
                          AllOf(HasSubstr("ahead"), HasSubstr("continue with 1000001")));
  FVD_EXPECT_ERROR(kSeqStale, (void)store_->find_repeated({9'000'000, "part", "chapter"}));
  end(1'010'000);
  EXPECT_EQ(newest(), 1'010'000);
}

TEST_F(SequenceNumbers, AreSurelyNewAboveTheNewestAlone) {
  const NewestSeqs newest{{"plc", 7}};
  EXPECT_TRUE(is_surely_new(newest, {8, "part", "chapter"}));
  EXPECT_TRUE(is_surely_new(newest, {7 + kSeqJump, "part", "chapter"}));
  EXPECT_FALSE(is_surely_new(newest, {8 + kSeqJump, "part", "chapter"})) << "which is refused";
  EXPECT_FALSE(is_surely_new(newest, {7, "part", "chapter"}));
  EXPECT_FALSE(is_surely_new(newest, {6, "part", "chapter"})) << "it may have been left out, or used";
  EXPECT_TRUE(is_surely_new(newest, {7, "part", "chapter", "fvdctl"})) << "of another client";
  end(7);
  EXPECT_FALSE(store_->find_repeated({8, "part", "chapter"}).has_value());
  EXPECT_TRUE(store_->find_repeated({7, "part", "chapter"}).has_value());
  EXPECT_FALSE(store_->find_repeated({6, "part", "chapter"}).has_value());
}

TEST_F(SequenceNumbers, AreNotRepeatedLongAfterTheirJobEnded) {
  end(7, "2026-01-01T00:00:00.000Z");
  FVD_EXPECT_ERROR_SAYING(kSeqStale, (void)store_->find_repeated({7, "part", "chapter"}),
                          AllOf(HasSubstr("rpc.repeat_window_s"), HasSubstr("a new part takes 8")));
  EXPECT_EQ(store_->find(ClientSeq{7}).result_json, "{}") << "the result itself is told as ever";
  end(8);
  EXPECT_TRUE(store_->find_repeated({8, "part", "chapter"}).has_value());
  open({.repeat_window = std::chrono::hours(24 * 365 * 500)});
  EXPECT_TRUE(store_->find_repeated({7, "part", "chapter"}).has_value());
}

TEST_F(SequenceNumbers, AreNotRepeatedInAnotherSession) {
  JobRequest request{7, "part", "chapter"};
  request.session = "monday";
  (void)store_->accept(request);
  EXPECT_TRUE(store_->find_repeated(request).has_value());
  request.session = "tuesday";
  FVD_EXPECT_ERROR_SAYING(kSeqConflict, (void)store_->find_repeated(request), HasSubstr("'monday'"));
  request.session.clear();
  FVD_EXPECT_ERROR(kSeqConflict, (void)store_->find_repeated(request));
  open();
  EXPECT_EQ(store_->find(ClientSeq{7}).status.request.session, "monday");
}

TEST_F(SequenceNumbers, AreNeverUsedAgainAfterAnOlderDatabaseWasPutBack) {
  end(7);
  const fs::path backup = folder_.path() / "backup.sqlite";
  store_.reset();
  copy_database(Database(file_), backup);
  open();
  end(8);
  end(9);
  const std::int64_t epoch = store_->epoch();
  store_.reset();
  fs::remove(file_);
  fs::copy_file(backup, file_);

  open();

  EXPECT_GT(store_->epoch(), epoch) << "the epoch never goes back";
  EXPECT_TRUE(store_->find_repeated({7, "part", "chapter"}).has_value());
  for (const std::int64_t used : {8, 9}) {
    FVD_EXPECT_ERROR_SAYING(kSeqStale, (void)store_->accept({used, "part", "chapter"}), HasSubstr("restored"));
  }
  EXPECT_NO_THROW(end(newest() + 1));
  open();
  FVD_EXPECT_ERROR(kSeqStale, (void)store_->accept({9, "part", "chapter"}));
}

TEST_F(SequenceNumbers, AreNeverUsedAgainAfterACopyOfTheSameEpochWasPutBack) {
  end(7);
  const fs::path copy = folder_.path() / "copy.sqlite";
  copy_database_in_use(file_, copy);
  end(8);
  store_.reset();
  fs::rename(copy, file_);
  open();
  FVD_EXPECT_ERROR_SAYING(kSeqStale, (void)store_->accept({8, "part", "chapter"}), HasSubstr("restored"));
  EXPECT_NO_THROW(end(newest() + 1));
  const std::int64_t used = newest();
  open();
  EXPECT_EQ(newest(), used) << "once";
}

TEST_F(SequenceNumbers, AreNeverUsedAgainWhereTheMarkerKnowsNewerOnes) {
  end(7);
  store_.reset();
  StoreMarker marker = read_marker(file_).value();
  marker.newest_seq["plc"] = 9;
  write_marker(file_, marker);
  open();
  FVD_EXPECT_ERROR(kSeqStale, (void)store_->accept({9, "part", "chapter"}));
}

TEST_F(SequenceNumbers, OfADatabaseThatIsGoneAreNeverUsedAgain) {
  end(7);
  const std::int64_t epoch = store_->epoch();
  store_.reset();
  fs::remove(file_);

  FVD_EXPECT_ERROR_SAYING(kDatabase, JobStore{file_}, AllOf(HasSubstr("fvdctl restore"), HasSubstr("--new-database")));
  EXPECT_FALSE(fs::exists(file_)) << "a refusal makes none";

  open({.start_anew = true});
  EXPECT_GT(store_->epoch(), epoch);
  FVD_EXPECT_ERROR(kSeqStale, (void)store_->accept({7, "part", "chapter"}));
  EXPECT_NO_THROW(end(newest() + 1));
}

TEST_F(SequenceNumbers, AreKnownBesideTheDatabaseHoweverLongTheDaemonRuns) {
  for (std::int64_t seq = 1; seq < 60'000; seq += kSeqJump / 2) end(seq);
  const std::int64_t used = newest();
  store_.reset();
  fs::remove(file_);
  open({.start_anew = true});
  EXPECT_GE(newest(), used);
}

TEST(ADatabaseThatIsGone, IsMissedWhereResultsAreThereAlone) {
  const test::ScratchDir folder;
  fs::create_directories(folder.path() / "results" / ".J1.1-0.tmp");
  EXPECT_NO_THROW(JobStore(folder.path() / "a.sqlite")) << "what a killed process left is no result";
  fs::create_directories(folder.path() / "results" / "J1");
  FVD_EXPECT_ERROR_SAYING(kDatabase, JobStore(folder.path() / "b.sqlite"), HasSubstr("results"));
}

TEST(AMarker, ThatCannotBeReadIsNotOverwritten) {
  const test::ScratchDir folder;
  test::write_text(folder.path() / "fvd.epoch", "{");
  FVD_EXPECT_ERROR_SAYING(kDatabase, JobStore(folder.path() / "fvd.sqlite", {.start_anew = true}),
                          HasSubstr("fvd.epoch"));
  EXPECT_EQ(test::read_text(folder.path() / "fvd.epoch"), "{");
}

}  // namespace
}  // namespace fvd
