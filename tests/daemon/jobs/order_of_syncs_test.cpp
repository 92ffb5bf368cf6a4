/// What must be on the disk before something else is put in force: a power cut keeps no order of its own.

#include <algorithm>
#include <cerrno>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/backup/backup.hpp"
#include "daemon/backup/restore.hpp"
#include "daemon/calibration/calibration_book.hpp"
#include "daemon/recipes/recipe_book.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/daemon/jobs/faulty_calls.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

/// Follows which entries of directories a power cut may take.
class UnsyncedEntries final : public FileCalls {
 public:
  /// What was unsynced when a file got this name is kept.
  explicit UnsyncedEntries(fs::path in_force = {}) : in_force_(std::move(in_force)) {}

  int create(const fs::path& path, mode_t mode) override {
    const int fd = FileCalls::create(path, mode);
    if (fd >= 0) came_from_[path] = path.parent_path();
    return fd;
  }
  int make_directory(const fs::path& path) override {
    const int done = FileCalls::make_directory(path);
    if (done == 0) came_from_[path] = path.parent_path();
    return done;
  }
  int rename(const fs::path& from, const fs::path& to) override {
    came_from_.erase(from);
    if (to == in_force_) before_in_force = now();
    came_from_[to] = from.parent_path();
    return FileCalls::rename(from, to);
  }
  int unlink(const fs::path& path) override {
    came_from_.erase(path);
    return FileCalls::unlink(path);
  }
  int sync_directory(const fs::path& path) override {
    for (const auto& [entry, from] : came_from_) {
      if (from == path && entry.parent_path() != path) in_neither.push_back(entry);
    }
    std::erase_if(came_from_, [&](const auto& entry) { return entry.first.parent_path() == path; });
    return FileCalls::sync_directory(path);
  }

  [[nodiscard]] std::vector<fs::path> now() const {
    std::vector<fs::path> entries;
    for (const auto& [entry, from] : came_from_) entries.push_back(entry);
    return entries;
  }
  std::vector<fs::path> before_in_force;
  std::vector<fs::path> in_neither;  ///< gone from one directory for good before it was in the other for good

 private:
  const fs::path in_force_;
  std::map<fs::path, fs::path> came_from_;  // unsynced entry and the directory in which it was
};

class APowerCut : public testing::Test {
 protected:
  test::ScratchDir folder_;
};

TEST_F(APowerCut, TakesNoFolderThatWasMade) {
  UnsyncedEntries calls;
  const ReplacedFileCalls replaced(calls);
  make_directories(folder_ / "a" / "b" / "c");
  EXPECT_THAT(calls.now(), IsEmpty());
}

TEST_F(APowerCut, TakesNoFolderThatWasMadeAtTheSecondAttempt) {
  {
    test::FaultyCalls calls(1, EIO, test::FaultLasts::kOnce);
    const ReplacedFileCalls replaced(calls);
    FVD_EXPECT_ERROR(kStorageWrite, make_directories(folder_ / "a"));
  }
  UnsyncedEntries calls;
  const ReplacedFileCalls replaced(calls);
  EXPECT_FALSE(fs::exists(folder_ / "a")) << "it would be taken for one that is on the disk";
  make_directories(folder_ / "a");
  EXPECT_TRUE(fs::exists(folder_ / "a"));
}

TEST_F(APowerCut, TakesNoRecipeThatWasSaved) {
  fs::create_directory(folder_ / "shipped");
  test::write_text(folder_ / "shipped" / "part.json", R"({"scan": {"start_um": 0, "step_um": 1, "slices": 11}})");
  JobStore store(folder_ / "fvd.sqlite");
  RecipeBook book({folder_ / "shipped", folder_ / "edited"},
                  {Micrometers{-10}, Micrometers{100}, Micrometers{5}, 1000.0}, store.recipe_versions());
  UnsyncedEntries calls;
  const ReplacedFileCalls replaced(calls);
  (void)book.save({"part", R"({"scan": {"start_um": 0, "step_um": 1, "slices": 12}})", 0, "anna", ""});
  EXPECT_THAT(calls.now(), Not(Contains(folder_ / "edited")));
}

TEST_F(APowerCut, TakesNoFileOfConstantsThatAreInForce) {
  const fs::path folder = folder_ / "calibration";
  CalibrationBook book(folder);
  UnsyncedEntries calls(folder / "calibration.json");
  const ReplacedFileCalls replaced(calls);
  const Calibration added = book.add("10x", [](Calibration& next) {
    next.noise = NoiseConstants{0.05, {}};
    return std::vector<CalibrationFile>{{next.id + "-a.gsf", "bytes"}};
  });
  ASSERT_TRUE(fs::exists(folder / (added.id + "-a.gsf")));
  EXPECT_THAT(calls.before_in_force, Not(Contains(folder / (added.id + "-a.gsf"))));
  EXPECT_THAT(calls.now(), IsEmpty());
}

TEST_F(APowerCut, TakesNeitherARestoredResultNorTheReplacedDatabase) {
  const InstrumentPaths paths{folder_ / "state", folder_ / "recipes", folder_ / "fvd.json"};
  fs::create_directories(paths.recipe_dir);
  const fs::path database = paths.state_dir / "fvd.sqlite";
  fs::path result;
  {
    JobStore store(database);
    JobStatus job = store.accept({7, "part", "chapter"});
    job.state = JobState::kCompleted;
    result = paths.state_dir / "results" / job.job_id;
    fs::create_directories(result);
    test::write_text(result / "result.json", "{}");
    store.finish(job, result.string(), "{}");
  }
  (void)make_backup(paths, folder_ / "backup", true);
  fs::remove_all(result);

  UnsyncedEntries calls(database);
  const ReplacedFileCalls replaced(calls);
  const Restored restored = restore_backup(folder_ / "backup", paths);

  ASSERT_TRUE(fs::exists(result / "result.json"));
  ASSERT_TRUE(fs::exists(restored.replaced / "fvd.sqlite"));
  EXPECT_THAT(calls.before_in_force, IsEmpty());
  EXPECT_THAT(calls.in_neither, IsEmpty());
  EXPECT_THAT(calls.now(), Not(Contains(database)));
}

}  // namespace
}  // namespace fvd
