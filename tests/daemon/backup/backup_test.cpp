#include "daemon/backup/backup.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/backup/restore.hpp"
#include "daemon/base/unique_fd.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// An instrument that has measured.
class AnInstrument : public testing::Test {
 protected:
  AnInstrument() {
    fs::create_directories(paths_.state_dir / "calibration");
    fs::create_directories(paths_.state_dir / "studies" / "study-0001");
    fs::create_directories(paths_.recipe_dir / "masks");
    test::write_text(paths_.state_dir / "calibration" / "calibration.json", "{}");
    test::write_text(paths_.state_dir / "studies" / "study-0001" / "study.json", "{}");
    test::write_text(paths_.state_dir / "stage_history.json", "{\"scans\": 1}");
    test::write_text(paths_.recipe_dir / "part.json", "{}");
    test::write_text(paths_.recipe_dir / "masks" / "a.png", "png");
    test::write_text(paths_.config_file, "{}");
    open();
  }
  void open() {
    store_.reset();
    store_ = std::make_unique<JobStore>(paths_.state_dir / "fvd.sqlite");
  }
  std::string measure(std::int64_t seq) {
    JobStatus job = store_->accept({seq, "part", "chapter"});
    job.state = JobState::kCompleted;
    const fs::path result = paths_.state_dir / "results" / job.job_id;
    fs::create_directories(result / "slices");
    test::write_text(result / "result.json", "{\"seq\": " + std::to_string(seq) + "}");
    test::write_text(result / "slices" / "z.txt", "1");
    store_->finish(job, result.string(), "{\"seq\": " + std::to_string(seq) + "}");
    return job.job_id;
  }
  [[nodiscard]] std::int64_t newest() const { return store_->newest_seqs()->at("plc"); }

  test::ScratchDir folder_;
  InstrumentPaths paths_{folder_ / "state", folder_ / "recipes", folder_ / "fvd.json"};
  fs::path backup_ = folder_ / "backup";
  std::unique_ptr<JobStore> store_;
};

TEST_F(AnInstrument, IsBackedUpWhileItMeasures) {
  std::atomic<bool> done = false;
  std::atomic<std::int64_t> measured = 0;
  std::thread measuring([&] {
    for (std::int64_t seq = 1; !done || seq < 20; ++seq) {
      measure(seq);
      measured = seq;
    }
  });
  while (measured < 5) std::this_thread::yield();
  const std::int64_t before = measured;
  const auto missing = make_backup(paths_, backup_, true);
  done = true;
  measuring.join();

  EXPECT_TRUE(missing.empty());
  const JobStore copy(backup_ / "fvd.sqlite", {.start_anew = true});
  for (std::int64_t seq = 1; seq <= before; ++seq) {
    const StoredJob job = copy.find(ClientSeq{seq});
    const fs::path result = backup_ / "results" / job.status.job_id;
    EXPECT_EQ(test::read_text(result / "result.json"), job.result_json) << seq;
    EXPECT_TRUE(fs::exists(result / "slices" / "z.txt"));
  }
  EXPECT_EQ(test::read_text(backup_ / "recipes" / "masks" / "a.png"), "png");
  EXPECT_TRUE(fs::exists(backup_ / "state" / "studies" / "study-0001" / "study.json"));
  EXPECT_TRUE(fs::exists(backup_ / "fvd.json"));
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)make_backup(paths_, backup_, false), HasSubstr("exists already"));
}

TEST_F(AnInstrument, IsBackedUpWhereAFolderIsAndNotIntoItself) {
  const fs::path unmounted = backup_.parent_path() / "no-disk" / "backup";
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)make_backup(paths_, unmounted, false), HasSubstr("is its disk mounted?"));
  EXPECT_FALSE(fs::exists(unmounted.parent_path()));
  const fs::path inside = paths_.state_dir / "backup";
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)make_backup(paths_, inside, false), HasSubstr("inside of the state folder"));
  EXPECT_FALSE(fs::exists(inside));
}

TEST_F(AnInstrument, LeavesNoHalfBackup) {
  fs::remove_all(paths_.recipe_dir);
  fs::create_symlink(folder_ / "nowhere", folder_ / "dangling");
  store_.reset();
  fs::remove(paths_.state_dir / "fvd.sqlite");
  FVD_EXPECT_ERROR(kDatabase, (void)make_backup(paths_, backup_, false));
  EXPECT_FALSE(fs::exists(backup_));
  EXPECT_FALSE(fs::exists(folder_ / "backup.tmp"));
}

/// Does something once, when a file is made below a folder.
class OnFirstFile : public FileCalls {
 public:
  OnFirstFile(fs::path below, std::function<void()> action) : below_(std::move(below)), action_(std::move(action)) {}
  int create(const fs::path& path, mode_t mode) override {
    if (path.string().starts_with(below_.string())) {
      if (const auto action = std::exchange(action_, nullptr)) action();
    }
    return FileCalls::create(path, mode);
  }

 private:
  const fs::path below_;
  std::function<void()> action_;
};

TEST_F(AnInstrument, IsBackedUpThoughAResultIsRemovedMeanwhile) {
  const std::string first = measure(1);
  const std::string second = measure(2);
  OnFirstFile removal(folder_ / "backup.tmp" / "results", [&] {
    fs::rename(paths_.state_dir / "results" / first, paths_.state_dir / "results" / ".gone");
  });
  const ReplacedFileCalls replaced(removal);
  EXPECT_EQ(make_backup(paths_, backup_, true), std::vector{first});
  EXPECT_TRUE(fs::exists(backup_ / "results" / second / "slices" / "z.txt"));
  EXPECT_FALSE(fs::exists(backup_ / "results" / first));
}

TEST_F(AnInstrument, RemovesNoFolderThatAnotherBackupMayBeFilling) {
  fs::create_directory(folder_ / "backup.tmp");
  test::write_text(folder_ / "backup.tmp" / "mine", "x");
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)make_backup(paths_, backup_, false), HasSubstr("backup.tmp"));
  EXPECT_TRUE(fs::exists(folder_ / "backup.tmp" / "mine"));
}

TEST_F(AnInstrument, IsHeldUntilItIsRestored) {
  measure(1);
  (void)make_backup(paths_, backup_, false);
  store_.reset();
  bool held = false;
  OnFirstFile look(paths_.state_dir / "stage_history", [&] {
    const UniqueFd old(::open((paths_.state_dir / "replaced-1" / "fvd.sqlite").c_str(), O_RDONLY | O_CLOEXEC));
    held = old.valid() && ::flock(old.get(), LOCK_EX | LOCK_NB) != 0;
  });
  const ReplacedFileCalls replaced(look);
  (void)restore_backup(backup_, paths_);
  EXPECT_TRUE(held);
}

TEST_F(AnInstrument, IsRestoredAndNoNumberRunsTwice) {
  const std::string first = measure(1);
  (void)make_backup(paths_, backup_, true);
  const std::string second = measure(2);
  const std::string third = measure(3);
  const std::int64_t epoch = store_->epoch();
  test::write_text(paths_.state_dir / "stage_history.json", "{\"scans\": 2}");
  FVD_EXPECT_ERROR_SAYING(kBusy, (void)restore_backup(backup_, paths_), HasSubstr("another fvd"));
  store_.reset();
  fs::remove_all(paths_.state_dir / "results" / first);

  const Restored restored = restore_backup(backup_, paths_);

  EXPECT_EQ(restored.margin, 0);
  EXPECT_EQ(restored.results, 1);
  EXPECT_EQ(restored.unknown, (std::vector{second, third})) << "measured since the backup: they stay";
  EXPECT_TRUE(fs::exists(paths_.state_dir / "results" / second / "result.json"));
  EXPECT_EQ(test::read_text(paths_.state_dir / "stage_history.json"), "{\"scans\": 1}");
  EXPECT_EQ(test::read_text(restored.replaced / "stage_history.json"), "{\"scans\": 2}");
  EXPECT_TRUE(fs::exists(restored.replaced / "fvd.sqlite"));
  open();
  EXPECT_GT(store_->epoch(), epoch);
  EXPECT_EQ(newest(), 3) << "known from the database that was replaced";
  EXPECT_EQ(store_->find(ClientSeq{1}).status.job_id, first);
  EXPECT_TRUE(fs::exists(paths_.state_dir / "results" / first / "result.json"));
  for (const std::int64_t used : {2, 3}) {
    FVD_EXPECT_ERROR(kSeqStale, (void)store_->accept({used, "part", "chapter"}));
  }
  EXPECT_NO_THROW(measure(4));
}

TEST_F(AnInstrument, IsRestoredOnAnotherMachine) {
  const std::string first = measure(1);
  (void)make_backup(paths_, backup_, true);
  measure(2);
  const std::int64_t epoch = store_->epoch();
  const InstrumentPaths other{folder_ / "other" / "state", folder_ / "other" / "recipes",
                              folder_ / "other" / "fvd.json"};

  const Restored restored = restore_backup(backup_, other);

  EXPECT_GT(restored.margin, 0);
  EXPECT_TRUE(restored.unknown.empty());
  EXPECT_TRUE(restored.replaced.empty());
  EXPECT_EQ(test::read_text(other.recipe_dir / "masks" / "a.png"), "png");
  EXPECT_TRUE(fs::exists(other.config_file));
  JobStore store(other.state_dir / "fvd.sqlite");
  EXPECT_GT(store.epoch(), epoch);
  EXPECT_EQ(store.find(ClientSeq{1}).result_dir, (other.state_dir / "results" / first).string());
  EXPECT_TRUE(fs::exists(store.find(ClientSeq{1}).result_dir));
  FVD_EXPECT_ERROR(kSeqStale, (void)store.accept({2, "part", "chapter"}));
}

TEST_F(AnInstrument, IsRestoredTwiceAndForgetsNotThatNumbersMayBeUsed) {
  measure(1);
  (void)make_backup(paths_, backup_, true);
  measure(2);
  const InstrumentPaths other{folder_ / "other" / "state", folder_ / "other" / "recipes",
                              folder_ / "other" / "fvd.json"};
  for (int i = 0; i < 3; ++i) EXPECT_GT(restore_backup(backup_, other).margin, 0) << "no database here knew of 2";
  {
    JobStore store(other.state_dir / "fvd.sqlite");
    FVD_EXPECT_ERROR(kSeqStale, (void)store.accept({2, "part", "chapter"}));
  }
  EXPECT_EQ(restore_backup(backup_, other).margin, 0) << "the one that ran since knows which numbers are refused";
  JobStore store(other.state_dir / "fvd.sqlite");
  FVD_EXPECT_ERROR(kSeqStale, (void)store.accept({2, "part", "chapter"}));
}

TEST_F(AnInstrument, IsRestoredTwiceInItsPlaceAndKnowsItsNumbersStill) {
  measure(1);
  (void)make_backup(paths_, backup_, true);
  measure(2);
  store_.reset();
  for (int i = 0; i < 2; ++i) EXPECT_EQ(restore_backup(backup_, paths_).margin, 0);
  open();
  EXPECT_EQ(newest(), 2);
  EXPECT_NO_THROW(measure(3));
}

/// The permissions of a file when it is made and when its first bytes are written.
class FirstBytes final : public FileCalls {
 public:
  explicit FirstBytes(std::string name) : name_(std::move(name)) {}
  int create(const fs::path& path, mode_t mode) override {
    const int fd = FileCalls::create(path, mode);
    if (path.filename() != name_) return fd;
    struct stat info {};
    fd_ = fd;
    if (::fstat(fd, &info) == 0) mode_at_first = info.st_mode & 0777U;
    return fd;
  }
  ssize_t write(int fd, const void* bytes, std::size_t count) override {
    struct stat info {};
    if (fd == std::exchange(fd_, fd == fd_ ? -1 : fd_) && ::fstat(fd, &info) == 0) mode_at_bytes = info.st_mode & 0777U;
    return FileCalls::write(fd, bytes, count);
  }
  std::optional<mode_t> mode_at_first;
  std::optional<mode_t> mode_at_bytes;

 private:
  const std::string name_;
  int fd_ = -1;
};

TEST_F(AnInstrument, HasItsTokensCopiedByNobodyButWhoMayReadThem) {
  paths_.token_file = folder_ / "tokens";
  test::write_text(paths_.token_file, "secret");
  fs::permissions(paths_.token_file, fs::perms::owner_read | fs::perms::owner_write);
  FirstBytes calls("tokens");
  const ReplacedFileCalls replaced(calls);
  (void)make_backup(paths_, backup_, false);
  EXPECT_EQ(calls.mode_at_first, 0600U) << "whoever opens it then reads all that comes";
  EXPECT_EQ(calls.mode_at_bytes, 0600U);
  EXPECT_EQ(test::read_text(backup_ / "tokens"), "secret");
}

TEST_F(AnInstrument, IsNotRestoredWithoutResultsThatCannotBeListed) {
  measure(1);
  (void)make_backup(paths_, backup_, false);
  store_.reset();
  fs::remove_all(backup_ / "results");
  EXPECT_EQ(restore_backup(backup_, paths_).results, 0) << "a backup without results";
  test::write_text(backup_ / "results", "no folder");
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)restore_backup(backup_, paths_), HasSubstr("results"));
}

TEST_F(AnInstrument, KeepsNoCopyOfAnOlderBackupsDatabase) {
  (void)make_backup(paths_, backup_, false);
  store_.reset();
  fs::copy_file(FVD_TEST_DATA "/fvd_0.1.0.sqlite", backup_ / "fvd.sqlite", fs::copy_options::overwrite_existing);
  (void)restore_backup(backup_, paths_);
  for (const auto& entry : fs::directory_iterator(paths_.state_dir)) {
    EXPECT_THAT(entry.path().filename().string(), testing::Not(testing::StartsWith("fvd.restored")));
  }
  EXPECT_NO_THROW(open());
}

TEST_F(AnInstrument, SaysOfAJobThatRanThatTheBackupLacksItsResult) {
  (void)store_->accept({1, "part", "chapter"});
  const std::string before = utc_now();
  (void)make_backup(paths_, backup_, false);
  const std::string after = utc_now();
  store_.reset();
  (void)restore_backup(backup_, paths_);
  open();

  const JobStatus job = store_->find(ClientSeq{1}).status;
  EXPECT_EQ(job.error, ErrorCode::kInterrupted);
  EXPECT_THAT(job.error_message, HasSubstr("the backup was made while the job ran"));
  EXPECT_GE(job.ended_utc, before);
  EXPECT_LE(job.ended_utc, after);
  EXPECT_EQ(store_->interrupted_by_start(), std::vector{job.job_id}) << "a whole result of it that is here is its own";
}

TEST_F(AnInstrument, SaysSoOfABackupThatAnEarlierVersionMade) {
  (void)store_->accept({1, "part", "chapter"});
  (void)make_backup(paths_, backup_, false);
  Database(backup_ / "fvd.sqlite").execute("UPDATE jobs SET error_message = '', ended_utc = ''");
  const timespec times[] = {{1'700'000'000, 0}, {1'700'000'000, 0}};
  ASSERT_EQ(::utimensat(AT_FDCWD, (backup_ / "fvd.sqlite").c_str(), times, 0), 0);
  store_.reset();
  (void)restore_backup(backup_, paths_);
  open();

  EXPECT_EQ(store_->find(ClientSeq{1}).status.ended_utc, "2023-11-14T22:13:20.000Z");
  EXPECT_THAT(store_->find(ClientSeq{1}).status.error_message, HasSubstr("the backup was made while the job ran"));
}

TEST_F(AnInstrument, WritesDownWhoRestoredItFromWhere) {
  (void)make_backup(paths_, backup_, false);
  store_.reset();
  const std::string before = utc_now();
  const Restored restored = restore_backup(backup_, paths_);
  open();

  const std::vector<AuditEntry> entries = store_->audit().newest(10);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].what, "restore");
  EXPECT_EQ(entries[0].who, "uid " + std::to_string(::getuid()));
  EXPECT_EQ(entries[0].outcome, "ok");
  EXPECT_GE(entries[0].time_utc, before);
  EXPECT_EQ(entries[0].detail,
            "from " + backup_.string() + "; the next epoch is " + std::to_string(restored.epoch + 1));
  EXPECT_EQ(store_->epoch(), restored.epoch + 1);
}

TEST_F(AnInstrument, NamesTheDamagedFileOfABackupAndTouchesNothing) {
  for (std::int64_t seq = 1; seq <= 200; ++seq) measure(seq);
  (void)make_backup(paths_, backup_, false);
  store_.reset();
  const std::string whole = test::read_text(backup_ / "fvd.sqlite");
  const std::string torn = whole.substr(0, 8192) + std::string(whole.size() - 8192, '\xff');
  for (const std::string& damaged : {std::string(4096, 'x'), std::string(), torn}) {
    test::write_text(backup_ / "fvd.sqlite", damaged);
    FVD_EXPECT_ERROR_SAYING(
        kDatabase, (void)restore_backup(backup_, paths_),
        testing::AllOf(HasSubstr((backup_ / "fvd.sqlite").string()), HasSubstr("damaged"),
                       testing::Not(HasSubstr("fvd.restored")), testing::Not(HasSubstr("start anew"))));
    EXPECT_FALSE(fs::exists(paths_.state_dir / "fvd.restored"));
  }
  open();
  EXPECT_EQ(newest(), 200);
}

TEST_F(AnInstrument, IsNotRestoredFromAFolderThatIsNoBackup) {
  FVD_EXPECT_ERROR_SAYING(kBadInput, (void)restore_backup(folder_ / "nothing", paths_), HasSubstr("no backup"));
  EXPECT_NO_THROW(measure(1)) << "nothing was touched";
}

TEST_F(AnInstrument, KeepsWhatTheLastTwoRestorationsReplaced) {
  (void)make_backup(paths_, backup_, false);
  store_.reset();
  Restored restored;
  for (int i = 1; i <= 4; ++i) restored = restore_backup(backup_, paths_);
  EXPECT_EQ(restored.replaced, paths_.state_dir / "replaced-4");
  EXPECT_EQ(restored.dropped, std::vector<fs::path>{paths_.state_dir / "replaced-2"});
  EXPECT_FALSE(fs::exists(paths_.state_dir / "replaced-1"));
  EXPECT_TRUE(fs::exists(paths_.state_dir / "replaced-3"));
}

TEST_F(AnInstrument, KeepsTheReplacedDatabaseHoweverManyAttemptsFailedAfterIt) {
  (void)make_backup(paths_, backup_, false);
  store_.reset();
  (void)restore_backup(backup_, paths_);
  // As attempts leave them that ended before the database was in its place.
  for (const char* attempt : {"replaced-2", "replaced-3"}) fs::create_directory(paths_.state_dir / attempt);
  fs::remove(paths_.state_dir / "fvd.sqlite");
  const Restored restored = restore_backup(backup_, paths_);
  EXPECT_TRUE(restored.dropped.empty());
  EXPECT_TRUE(fs::exists(paths_.state_dir / "replaced-1" / "fvd.sqlite"));
}

}  // namespace
}  // namespace fvd
