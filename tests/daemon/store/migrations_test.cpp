/// Every step from the file that fvd 0.1.0 wrote to the newest version, and what becomes of the file when a step fails.

#include "daemon/store/migrations.hpp"

#include <cerrno>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/store/job_store.hpp"
#include "tests/daemon/store/broken_disk.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/service_manager.hpp"

namespace fvd {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// One job as every version keeps it.
using Row = std::vector<std::string>;

std::vector<Row> rows_of(const Database& database) {
  Statement query(
      database,
      "SELECT number, job_id, seq, part_id, recipe, state, error, error_message, acknowledged, slices_done, "
      "slices_planned, frames_expected, frames_ok, frames_incomplete, frames_missing, frames_stale, "
      "frames_underrun, created_utc, ended_utc, result_dir, result_json FROM jobs ORDER BY number");
  constexpr int kColumns = 21;
  std::vector<Row> rows;
  while (query.step()) {
    Row row;
    for (int column = 0; column < kColumns; ++column) row.push_back(query.text(column));
    rows.push_back(row);
  }
  return rows;
}

/// The tables as they are defined.
std::vector<std::string> schema_of(const Database& database) {
  Statement query(database, "SELECT type || ' ' || name || ' ' || coalesce(sql, '') FROM sqlite_schema ORDER BY 1");
  std::vector<std::string> objects;
  while (query.step()) objects.push_back(query.text(0));
  return objects;
}

class AFileOfVersion1 : public ::testing::Test {
 protected:
  AFileOfVersion1() { std::filesystem::copy_file(FVD_TEST_DATA "/fvd_0.1.0.sqlite", file_); }

  test::ScratchDir folder_;
  std::filesystem::path file_ = folder_.path() / "fvd.sqlite";
};

TEST_F(AFileOfVersion1, KeepsEveryRowThroughEveryStep) {
  Database database(file_);
  ASSERT_EQ(schema_version(database), 1);
  const std::vector<Row> before = rows_of(database);
  ASSERT_EQ(before.size(), 6U);

  for (int version = 2; version <= newest_schema_version(); ++version) {
    migrate(database, version);
    EXPECT_EQ(schema_version(database), version);
    EXPECT_EQ(rows_of(database), before) << "at version " << version;
  }
}

TEST_F(AFileOfVersion1, HasTheTablesOfANewFileInTheEnd) {
  Database old_file(file_);
  migrate(old_file);
  Database new_file(folder_.path() / "new.sqlite");
  migrate(new_file);
  EXPECT_EQ(schema_of(old_file), schema_of(new_file));
  EXPECT_EQ(schema_version(old_file), schema_version(new_file));
}

TEST_F(AFileOfVersion1, IsKeptAsACopyBeforeItIsMigrated) {
  std::vector<Row> before;
  {
    Database database(file_);
    before = rows_of(database);
    migrate(database);
  }
  const Database copy(folder_.path() / "fvd.sqlite.v1");
  EXPECT_EQ(schema_version(copy), 1);
  EXPECT_EQ(rows_of(copy), before);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "fvd.sqlite.v1.tmp"));
}

TEST_F(AFileOfVersion1, StaysAsItIsOnceItIsOfTheNewestVersion) {
  Database database(file_);
  migrate(database);
  const auto rows = rows_of(database);
  migrate(database);
  EXPECT_EQ(rows_of(database), rows);
}

TEST_F(AFileOfVersion1, GoesOnAsAStore) {
  JobStore store(file_);

  EXPECT_EQ(store.epoch(), 3) << "it was opened twice before";
  EXPECT_EQ(store.unacknowledged_count(), 5);
  const StoredJob completed = store.find(ClientSeq{4711});
  EXPECT_EQ(completed.status.request.client, kDefaultClient) << "old rows belong to the plain PLC";
  EXPECT_EQ(completed.status.request.part_id, "P-0815");
  EXPECT_EQ(completed.status.state, JobState::kCompleted);
  EXPECT_TRUE(completed.status.acknowledged);
  EXPECT_EQ(completed.status.frames.ok, 21U);
  EXPECT_THAT(completed.result_json, HasSubstr("\"valid_fraction\": 0.969323"));
  EXPECT_EQ(store.find(ClientSeq{4712}).status.state, JobState::kAborted);
  EXPECT_EQ(store.find(ClientSeq{4714}).status.error, ErrorCode::kStageDisconnected);
  EXPECT_EQ(store.find(ClientSeq{4721}).status.error, ErrorCode::kInterrupted) << "it was running";
  FVD_EXPECT_ERROR_SAYING(kSeqStale, (void)store.find_repeated({4711, "P-0815", "chapter"}),
                          HasSubstr(completed.status.job_id));
  FVD_EXPECT_ERROR(kSeqConflict, (void)store.find_repeated({4711, "another", "chapter"}));
  EXPECT_THAT(store.accept({4722, "P-0821", "chapter"}).job_id, ::testing::EndsWith("-00003-000007"));
}

TEST_F(AFileOfVersion1, GivesNoNumberOfADeletedJobAgain) {
  Database(file_).execute("DELETE FROM jobs WHERE number > 4");
  JobStore store(file_);
  EXPECT_THAT(store.accept({1, "part", "chapter", "new"}).job_id, ::testing::EndsWith("-000007"));
}

TEST_F(AFileOfVersion1, GivesNoNumberAgainWhenAllJobsWereDeleted) {
  Database(file_).execute("DELETE FROM jobs");
  JobStore store(file_);
  EXPECT_THAT(store.accept({1, "part", "chapter"}).job_id, ::testing::EndsWith("-000007"));
}

TEST_F(AFileOfVersion1, StaysWholeWhereverTheDiskGetsFull) {
  std::vector<Row> before;
  {
    const Database database(file_);
    before = rows_of(database);
  }
  bool failed = true;
  int failures = 0;
  for (int good_writes = 0; failed; ++good_writes) {
    ASSERT_LT(good_writes, 1000);
    {
      Database database(file_);
      const test::BrokenDisk full(ENOSPC, good_writes);
      try {
        migrate(database);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kStorageFull) << error.what();
      }
      failed = full.has_failed();
    }
    const Database database(file_);
    EXPECT_EQ(rows_of(database), before) << "after " << good_writes << " writes";
    if (failed) {
      ++failures;
      EXPECT_LT(schema_version(database), newest_schema_version()) << "after " << good_writes << " writes";
    } else {
      EXPECT_EQ(schema_version(database), newest_schema_version());
    }
  }
  EXPECT_GT(failures, 10) << "a step writes more often than that";
}

TEST_F(AFileOfVersion1, StaysWholeWhenAStepCannotRun) {
  Database database(file_);
  database.execute("CREATE TABLE jobs_2 (in_the_way TEXT)");
  const auto rows = rows_of(database);
  FVD_EXPECT_ERROR_SAYING(kDatabase, migrate(database), HasSubstr("jobs_2"));
  EXPECT_EQ(schema_version(database), 1);
  EXPECT_EQ(rows_of(database), rows);
}

TEST_F(AFileOfVersion1, IsNotCopiedTwiceWhereAMigrationWasCutOff) {
  const std::filesystem::path copy = file_.string() + ".v1";
  const std::filesystem::path before = folder_.path() / "before.sqlite";
  std::filesystem::copy_file(file_, before);
  const auto migrate_anew = [&] {
    std::filesystem::copy_file(before, file_, std::filesystem::copy_options::overwrite_existing);
    for (const char* log : {"-wal", "-shm"}) std::filesystem::remove(file_.string() + log);
    Database database(file_);
    migrate(database);
    return std::filesystem::last_write_time(copy);
  };
  const auto made = migrate_anew();
  EXPECT_EQ(migrate_anew(), made);
  Database(before).execute("UPDATE starts SET epoch = epoch + 1");
  EXPECT_NE(migrate_anew(), made) << "the older fvd ran since";
}

TEST_F(AFileOfVersion1, IsAnsweredInRetentionByIndexesAlone) {
  Database database(file_);
  migrate(database);
  const auto plan = [&database](const char* sql) {
    Statement rows(database, sql);
    return rows.step() ? rows.text(3) : "";
  };
  EXPECT_THAT(plan("EXPLAIN QUERY PLAN SELECT job_id, ended_utc, acknowledged, files_pending FROM jobs "
                   "WHERE result_dir <> '' AND removed_utc = '' ORDER BY number"),
              HasSubstr("COVERING INDEX jobs_with_results"));
  EXPECT_THAT(plan("EXPLAIN QUERY PLAN SELECT job_id FROM jobs WHERE removed_utc <> '' "
                   "ORDER BY removed_utc DESC LIMIT 100"),
              HasSubstr("COVERING INDEX jobs_with_removed_results"));
}

using AnUpgrade = test::AServiceManager;

TEST_F(AnUpgrade, AsksSystemdForMoreTime) {
  const test::ScratchDir folder;
  std::filesystem::copy_file(FVD_TEST_DATA "/fvd_0.1.0.sqlite", folder / "fvd.sqlite");
  Database database(folder / "fvd.sqlite");
  migrate(database, 2);
  EXPECT_THAT(heard(), AllOf(HasSubstr("EXTEND_TIMEOUT_USEC=90000000\n"), HasSubstr("STATUS=copying")));
  EXPECT_THAT(heard(), AllOf(HasSubstr("EXTEND_TIMEOUT_USEC="), HasSubstr("STATUS=bringing")));
}

TEST(AFileOfTheFuture, IsRefusedAndLeftAlone) {
  const test::ScratchDir folder;
  Database database(folder.path() / "fvd.sqlite");
  database.execute("CREATE TABLE jobs (of_the_future TEXT); PRAGMA user_version = 99");
  FVD_EXPECT_ERROR_SAYING(
      kDatabase, migrate(database),
      AllOf(HasSubstr("version 99"), HasSubstr("install the newer fvd"), HasSubstr("move the file")));
  EXPECT_EQ(schema_version(database), 99);
}

TEST(AFileOfAnotherProgram, IsRefusedAndLeftAloneByteForByte) {
  for (const char* version : {"0", "1", "2", "-7"}) {
    const test::ScratchDir folder;
    const auto file = folder.path() / "fvd.sqlite";
    Database(file).execute(("CREATE TABLE songs (title TEXT); PRAGMA user_version = " + std::string(version)).c_str());
    const std::string before = test::read_text(file);
    ASSERT_FALSE(before.empty());
    FVD_EXPECT_ERROR_SAYING(kDatabase, JobStore{file}, HasSubstr("another program"));
    EXPECT_EQ(test::read_text(file), before) << "version " << version;
  }
}

TEST_F(AFileOfVersion1, IsKeptWithOneOtherCopyAndNoMore) {
  for (const char* name : {"fvd.sqlite.v10", "fvd.sqlite.v9", "fvd.sqlite.v2", "fvd.sqlite.vx", "fvd.sqlite.v"}) {
    test::write_text(folder_ / name, "");
  }
  { const JobStore store(file_); }
  EXPECT_THAT(folder_.entries(), ::testing::IsSupersetOf({"fvd.sqlite.v1", "fvd.sqlite.v10", "fvd.sqlite.vx"}));
  for (const char* gone : {"fvd.sqlite.v9", "fvd.sqlite.v2"}) EXPECT_FALSE(folder_.entries().contains(gone)) << gone;
}

}  // namespace
}  // namespace fvd
