/// Every call by which files reach the disk fails once, in every way that disks fail.

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <functional>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/jobs/follow_result.hpp"
#include "daemon/jobs/result_pipeline.hpp"
#include "daemon/recipes/recipe_folder.hpp"
#include "daemon/store/store_marker.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;

/// The call after `good` others fails, and no other.
class FaultyCalls final : public FileCalls {
 public:
  FaultyCalls(int good, int reason) : left_(good), reason_(reason) {}
  [[nodiscard]] bool has_failed() const { return left_ < 0; }

  int create(const fs::path& path) override { return fails() ? -1 : FileCalls::create(path); }
  ssize_t write(int fd, const void* bytes, std::size_t count) override {
    return fails() ? -1 : FileCalls::write(fd, bytes, std::max<std::size_t>(1, count / 2));  // and never all at once
  }
  int sync(int fd) override { return fails() ? -1 : FileCalls::sync(fd); }
  int make_directory(const fs::path& path) override { return fails() ? -1 : FileCalls::make_directory(path); }
  int sync_directory(const fs::path& path) override { return fails() ? -1 : FileCalls::sync_directory(path); }
  int rename_to_new(const fs::path& from, const fs::path& to) override {
    return fails() ? -1 : FileCalls::rename_to_new(from, to);
  }
  int rename(const fs::path& from, const fs::path& to) override { return fails() ? -1 : FileCalls::rename(from, to); }

 private:
  bool fails() {
    if (left_-- != 0) return false;
    errno = reason_;
    return true;
  }
  std::atomic<int> left_;
  const int reason_;
};

class EveryWriteFault : public testing::TestWithParam<int> {
 protected:
  /// Has each of the calls of `work` fail once. after: looks at what a failure left, and at a success.
  void each(const std::function<void()>& work, const std::function<void(bool failed)>& after) {
    int faults = 0;
    for (bool failed = true; failed; ++faults) {
      ASSERT_LT(faults, 3000);
      FaultyCalls calls(faults, GetParam());
      bool refused = false;
      try {
        const ReplacedFileCalls replaced(calls);
        work();
      } catch (const Error& error) {
        refused = true;
        const ErrorCode expected = GetParam() == ENOSPC ? ErrorCode::kStorageFull : ErrorCode::kStorageWrite;
        EXPECT_EQ(error.code(), expected) << "call " << faults << ": " << error.what();
      }
      failed = calls.has_failed();
      EXPECT_FALSE(refused && !failed);
      after(refused);
    }
    std::cout << "{\"write_faults\": " << faults - 1 << "}" << std::endl;
  }
  test::ScratchDir folder_;
};

TEST_P(EveryWriteFault, LeavesNothingOfAResult) {
  each(
      [this] {
        AtomicDirectory directory(folder_ / "J7");
        (void)store_result(directory, test::sample_result());
      },
      [this](bool failed) {
        if (failed) {
          EXPECT_THAT(folder_.entries(), testing::IsEmpty());
        }
        fs::remove_all(folder_ / "J7");
      });
}

TEST_P(EveryWriteFault, LeavesAResultWholeWhoseOtherFilesFollow) {
  {
    AtomicDirectory directory(folder_ / "J7");
    (void)store_result(directory, test::sample_result());
  }
  const fs::path before = folder_ / "before";
  fs::copy(folder_ / "J7", before, fs::copy_options::recursive);
  const fs::path result = folder_ / "J7";
  each(
      [&] {
        fs::remove_all(result);
        fs::copy(before, result, fs::copy_options::recursive);
        const FollowedResult followed =
            follow_result({"J7", result.string(), test::read_text(result / "result.json"), {}}, {});
        if (followed.pending)
          throw Error(GetParam() == ENOSPC ? ErrorCode::kStorageFull : ErrorCode::kStorageWrite, followed.reason);
      },
      [&](bool) {
        for (const ResultFile& file : read_result_json(test::read_text(result / "result.json")).files) {
          if (file.state != FileState::kWritten) continue;
          EXPECT_EQ(fs::file_size(result / file.name), file.size_bytes) << file.name;
        }
      });
}

TEST_P(EveryWriteFault, LeavesTheOldMarkerOrTheNewOne) {
  const fs::path database = folder_ / "fvd.sqlite";
  write_marker(database, {.epoch = 1, .newest_seq = {}, .file = {}});
  each(
      [&] {
        write_marker(database, {.epoch = 2, .newest_seq = {{"plc", 7}}, .file = {}});
      },
      [&](bool failed) {
        const std::int64_t epoch = read_marker(database).value().epoch;
        EXPECT_EQ(epoch, failed ? epoch : 2);
        EXPECT_GE(epoch, 1);
      });
}

TEST_P(EveryWriteFault, LeavesNoNextTextOfARecipe) {
  each([&] { write_next_recipe_text(folder_.path(), "part", "{}"); },
       [&](bool failed) {
         EXPECT_EQ(find_next_recipe_text(folder_.path(), "part").has_value(), !failed);
         drop_next_recipe_text(folder_.path(), "part");
       });
}

INSTANTIATE_TEST_SUITE_P(Of, EveryWriteFault, testing::Values(ENOSPC, EIO, EROFS), [](const auto& of) {
  return std::string(of.param == ENOSPC ? "ENOSPC" : of.param == EIO ? "EIO" : "EROFS");
});

}  // namespace
}  // namespace fvd
