#include "daemon/store/storage_watch.hpp"

#include <cstring>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include "daemon/base/unique_fd.hpp"
#include "daemon/store/job_store.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class AStorageWatch : public ::testing::Test {
 protected:
  AStorageWatch() {
    test::write_text(database_, "x");
    fs::create_directories(results_);
  }
  [[nodiscard]] std::string problem(const StorageWatch& watch) const {
    const auto found = watch.look();
    return found ? std::string(error_name(found->code)) + ": " + found->message : "";
  }
  test::ScratchDir folder_;
  fs::path database_ = folder_.path() / "fvd.sqlite";
  fs::path results_ = folder_.path() / "results";
};

TEST_F(AStorageWatch, SeesADatabaseThatIsGoneOrAnotherOneAndIsContentWhenItIsBack) {
  const StorageWatch watch(database_, results_);
  EXPECT_EQ(problem(watch), "");
  const fs::path aside = folder_.path() / "aside";
  fs::rename(database_, aside);
  EXPECT_THAT(problem(watch), AllOf(HasSubstr("db_failed"), HasSubstr("is gone")));
  test::write_text(database_, "x");
  EXPECT_THAT(problem(watch), AllOf(HasSubstr("db_failed"), HasSubstr("another one")));
  fs::rename(aside, database_);
  EXPECT_EQ(problem(watch), "");
}

TEST_F(AStorageWatch, SeesAFolderOfResultsThatIsGoneOrAnotherOneAndIsContentWhenItIsBack) {
  const StorageWatch watch(database_, results_);
  const fs::path aside = folder_.path() / "aside";
  fs::rename(results_, aside);
  EXPECT_THAT(problem(watch), AllOf(HasSubstr("storage_write_failed"), HasSubstr("is gone")));
  fs::create_directory(results_);
  EXPECT_THAT(problem(watch), AllOf(HasSubstr("storage_write_failed"), HasSubstr("another one")));
  fs::remove(results_);
  fs::rename(aside, results_);
  EXPECT_EQ(problem(watch), "");
}

TEST_F(AStorageWatch, RefusesAResultThatDoesNotFit) {
  const StorageWatch watch(database_, results_);
  EXPECT_NO_THROW(watch.require_room(1U << 20U, "recipe a"));
  FVD_EXPECT_ERROR_SAYING(kStorageFull, watch.require_room(std::uint64_t{1} << 60U, "recipe a"),
                          AllOf(HasSubstr("recipe a: its result takes up to"), HasSubstr("free some disk space")));
}

/// A file system of its own, where this process may mount one.
class AMountedDisk : public ::testing::Test {
 protected:
  void mount(const char* size) {
    const std::string options = std::string("size=") + size;
    if (::mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, options.c_str()) != 0) {
      GTEST_SKIP() << "no file system can be mounted here: " << std::strerror(errno);
    }
    mounted_ = true;
    fs::create_directories(folder_.path() / "results");
  }
  ~AMountedDisk() override {
    if (mounted_) ::umount2(folder_.path().c_str(), MNT_DETACH);
  }
  [[nodiscard]] StorageWatch watch() const { return {folder_.path() / "fvd.sqlite", folder_.path() / "results"}; }
  test::ScratchDir folder_;
  bool mounted_ = false;
};

TEST_F(AMountedDisk, ThatIsFullIsAProblemAsLongAsItIs) {
  ASSERT_NO_FATAL_FAILURE(mount("64m"));
  if (!mounted_) return;
  JobStore store(folder_.path() / "fvd.sqlite");
  const StorageWatch watch = this->watch();
  EXPECT_FALSE(watch.look().has_value());
  {
    const UniqueFd filler(::open((folder_.path() / "filler").c_str(), O_WRONLY | O_CREAT, 0600));
    ASSERT_EQ(::posix_fallocate(filler.get(), 0, 52 << 20), 0);
    ASSERT_TRUE(watch.look().has_value());
    EXPECT_EQ(watch.look()->code, ErrorCode::kStorageFull);
  }
  fs::remove(folder_.path() / "filler");
  EXPECT_FALSE(watch.look().has_value());
}

TEST_F(AMountedDisk, ThatIsReadOnlyIsAProblemAsLongAsItIs) {
  ASSERT_NO_FATAL_FAILURE(mount("32m"));
  if (!mounted_) return;
  test::write_text(folder_.path() / "fvd.sqlite", "x");
  const StorageWatch watch = this->watch();
  EXPECT_FALSE(watch.look().has_value());
  ASSERT_EQ(::mount("tmpfs", folder_.path().c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  ASSERT_TRUE(watch.look().has_value());
  EXPECT_THAT(watch.look()->message, HasSubstr("read-only"));
  ASSERT_EQ(::mount("tmpfs", folder_.path().c_str(), nullptr, MS_REMOUNT, nullptr), 0);
  EXPECT_FALSE(watch.look().has_value());
}

TEST_F(AMountedDisk, ThatFillsUpWhileAJobRunsHasTheRoomForItsEnd) {
  ASSERT_NO_FATAL_FAILURE(mount("32m"));
  if (!mounted_) return;
  JobStore store(folder_.path() / "fvd.sqlite");
  JobStatus job = store.accept({1, "part", "chapter"});
  {
    // All that is left, to the last byte.
    const UniqueFd filler(::open((folder_.path() / "filler").c_str(), O_WRONLY | O_CREAT, 0600));
    const std::string piece(4096, 'x');
    while (::write(filler.get(), piece.data(), piece.size()) > 0) {
    }
  }
  job.state = JobState::kCompleted;
  store.finish(job, "dir", std::string(1U << 20U, ' '));
  EXPECT_EQ(store.find(ClientSeq{1}).status.not_durable, "");
  EXPECT_EQ(store.find(ClientSeq{1}).result_json.size(), 1U << 20U);
  FVD_EXPECT_ERROR(kStorageFull, (void)store.accept({2, "part", "chapter"}));
  fs::remove(folder_.path() / "filler");
  EXPECT_NO_THROW((void)store.accept({2, "part", "chapter"}));
}

}  // namespace
}  // namespace fvd
