#include "daemon/export/atomic_directory.hpp"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/unique_fd.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/exporter_table.hpp"
#include "daemon/export/recorded_slices.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/export/storage_error.hpp"
#include "tests/daemon/export/sample_result.hpp"
#include "tests/support/expect_error.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(AtomicDirectory, IsHiddenUntilItIsCommitted) {
  const ScratchDir scratch;
  AtomicDirectory directory(scratch / "job");
  directory.add_file("a.txt", "one");
  directory.add_file("more/b.txt", "two");
  EXPECT_FALSE(std::filesystem::exists(scratch / "job"));
  for (const auto& name : scratch.entries()) EXPECT_THAT(name, testing::StartsWith("."));

  directory.commit();

  EXPECT_THAT(scratch.entries(), ElementsAre("job"));
  EXPECT_EQ(test::read_text(scratch / "job/a.txt"), "one");
  EXPECT_EQ(test::read_text(scratch / "job/more/b.txt"), "two");
}

TEST(AtomicDirectory, HoldsMoreFilesThanMayBeOpenAtOnce) {
  const ScratchDir scratch;
  AtomicDirectory directory(scratch / "job");
  for (int i = 0; i < 40; ++i) directory.add_file("slices/" + std::to_string(i), std::to_string(i));
  EXPECT_LT(std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}), 30);
  directory.commit();
  for (int i = 0; i < 40; ++i)
    EXPECT_EQ(test::read_text(scratch / "job/slices" / std::to_string(i)), std::to_string(i));
}

TEST(AtomicDirectory, LeavesNothingWithoutCommit) {
  const ScratchDir scratch;
  {
    AtomicDirectory directory(scratch / "job");
    directory.add_file("more/b.txt", "two");
  }
  EXPECT_THAT(scratch.entries(), IsEmpty());
}

TEST(AtomicDirectory, TakesATrailingSlashForTheSameName) {
  const ScratchDir scratch;
  AtomicDirectory directory(scratch / "job/");
  directory.commit();
  EXPECT_THAT(scratch.entries(), ElementsAre("job"));
}

TEST(AtomicDirectory, RefusesANameThatExistsAsFileOrLink) {
  const ScratchDir scratch;
  test::write_text(scratch / "file", "");
  std::filesystem::create_symlink("nowhere", scratch / "link");
  for (const char* name : {"file", "link"}) {
    test::expect_error(ErrorCode::kStorageWrite, {name, "exists"}, [&] { const AtomicDirectory d(scratch / name); });
  }
}

TEST(AtomicDirectory, DoesNotReplaceADirectoryThatAppearedMeanwhile) {
  const ScratchDir scratch;
  {
    AtomicDirectory directory(scratch / "job");
    directory.add_file("a.txt", "one");
    std::filesystem::create_directory(scratch / "job");
    test::expect_error(ErrorCode::kStorageWrite, {"job"}, [&] { directory.commit(); });
  }
  EXPECT_THAT(scratch.entries(), ElementsAre("job"));
  EXPECT_TRUE(std::filesystem::is_empty(scratch / "job"));
}

TEST(AtomicDirectory, NamesTheParentThatIsMissing) {
  const ScratchDir scratch;
  test::expect_error(ErrorCode::kStorageWrite, {"nowhere", "No such file"},
                     [&] { const AtomicDirectory d(scratch / "nowhere/job"); });
}

TEST(AtomicDirectory, RefusesNamesThatLeadElsewhere) {
  const ScratchDir scratch;
  AtomicDirectory directory(scratch / "job");
  for (const char* name : {"", "/etc/x", "../x", "a/../x", "a/b/c", ".", "a/"}) {
    test::expect_error(ErrorCode::kBadInput, {"folder/file"}, [&] { directory.add_file(name, "x"); });
  }
}

TEST(AtomicDirectory, RefusesTheSameFileTwice) {
  const ScratchDir scratch;
  AtomicDirectory directory(scratch / "job");
  directory.add_file("a", "x");
  test::expect_error(ErrorCode::kStorageWrite, {"a", "exists"}, [&] { directory.add_file("a", "y"); });
}

TEST(AtomicDirectory, LeavesNothingBehindAnOversizedFile) {
  // In a child: the limit and the ignored signal are the process's.
  const ScratchDir scratch;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{600, 600};  // bytes: the first file fits, a later one does not
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_result(scratch / "job", test::sample_result());
      _exit(1);
    } catch (const Error& error) {
      const std::string message = error.what();
      // Two exporters run at a time, so that either may be first.
      const std::string name = message.substr(0, message.find(": "));
      const auto table = exporter_table();
      const bool named = std::any_of(table.begin(), table.end(), [&](const Exporter& row) { return row.name == name; });
      _exit(error.code() == ErrorCode::kStorageWrite && named && message.find("File too large") != std::string::npos
                ? 0
                : 2);
    }
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_THAT(scratch.entries(), IsEmpty());
}

TEST(AtomicDirectory, LeavesNothingOnAFullDisk) {
  const ScratchDir scratch;
  if (::mount("tmpfs", scratch.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "no right to mount a small tmpfs here";
  }
  ResultData data = test::sample_result();
  data.map = test::sample_map(400, 300);
  test::expect_error(ErrorCode::kStorageFull, {"No space left"}, [&] { write_result(scratch / "job", data); });
  EXPECT_THAT(scratch.entries(), IsEmpty());
  ::umount(scratch.path().c_str());
}

TEST(AtomicDirectory, SaysThatItMayNotWriteBesideTheTarget) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const ScratchDir scratch;
  ::chmod(scratch.path().c_str(), 0555);
  test::expect_error(ErrorCode::kStorageWrite, {"Permission denied"},
                     [&] { const AtomicDirectory d(scratch / "job"); });
  ::chmod(scratch.path().c_str(), 0755);
}

TEST(DurableFile, MapsAFullDeviceToStorageFull) {
  const UniqueFd full(::open("/dev/full", O_WRONLY | O_CLOEXEC));
  ASSERT_TRUE(full.valid());
  test::expect_error(ErrorCode::kStorageFull, {"map.tiff", "No space left"},
                     [&] { write_all(full.get(), "bytes", "map.tiff"); });
}

TEST(StorageError, TellsAFullDiskFromAllElse) {
  EXPECT_EQ(storage_error(ENOSPC, "write", "f").code(), ErrorCode::kStorageFull);
  EXPECT_EQ(storage_error(EDQUOT, "write", "f").code(), ErrorCode::kStorageFull);
  EXPECT_EQ(storage_error(EIO, "write", "f").code(), ErrorCode::kStorageWrite);
  EXPECT_STREQ(storage_error(EIO, "write", "/a/f").what(), "cannot write /a/f: Input/output error");
}

TEST(AbandonedDirectories, AreRemovedAndNothingElse) {
  const ScratchDir scratch;
  std::filesystem::create_directory(scratch / ".job.123-0.tmp");
  test::write_text(scratch / ".job.123-0.tmp/a", "x");
  std::filesystem::create_directory(scratch / "job");
  std::filesystem::create_directory(scratch / ".hidden");
  test::write_text(scratch / ".file.tmp", "x");
  EXPECT_EQ(remove_abandoned_directories(scratch.path()), 1U);
  EXPECT_THAT(scratch.entries(), ElementsAre(".file.tmp", ".hidden", "job"));
  EXPECT_EQ(remove_abandoned_directories(scratch / "nowhere"), 0U);
}

TEST(SliceRecorder, KeepsSlicesAndEveryDigitOfTheirHeight) {
  const ScratchDir scratch;
  AtomicDirectory directory(scratch / "job");
  SliceRecorder recorder(directory);
  Plane<std::uint16_t> pixels(2, 1);
  pixels.at(0, 0) = 0x0102;
  pixels.at(1, 0) = 0x0FFF;
  recorder.add(image_view(pixels.view(), PixelFormat::kMono12), 0.1 + 0.2);
  recorder.add(image_view(pixels.view(), PixelFormat::kMono12), 10.0);
  recorder.finish("job 7\nof a friend", true);
  directory.commit();
  EXPECT_EQ(test::read_text(scratch / "job/slices/slice_00000.pgm"), std::string("P5\n2 1\n4095\n\x01\x02\x0F\xFF"));
  EXPECT_EQ(test::read_text(scratch / "job/slices/z.txt"),
            "# job 7 of a friend, simulated\n# measured z in um, one line a slice\n0.30000000000000004\n10\n");
}

}  // namespace
}  // namespace fvd
