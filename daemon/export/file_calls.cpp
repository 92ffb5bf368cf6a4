#include "daemon/export/file_calls.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/export/storage_error.hpp"

namespace fvd {

namespace {

FileCalls& real_calls() noexcept {
  static FileCalls calls;
  return calls;
}

std::atomic<FileCalls*> replaced{nullptr};

}  // namespace

int FileCalls::create(const std::filesystem::path& path, mode_t mode) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
}

ssize_t FileCalls::write(int fd, const void* bytes, std::size_t count) { return ::write(fd, bytes, count); }

int FileCalls::allocate(int fd, std::int64_t bytes) {
  errno = ::posix_fallocate(fd, 0, bytes);
  return errno == 0 ? 0 : -1;
}

int FileCalls::sync(int fd) { return ::fsync(fd); }

int FileCalls::close(int fd) { return ::close(fd); }

int FileCalls::make_directory(const std::filesystem::path& path) { return ::mkdir(path.c_str(), 0755); }

int FileCalls::sync_directory(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return -1;
  const int synced = ::fsync(fd);
  const int reason = errno;
  ::close(fd);
  errno = reason;
  return synced;
}

int FileCalls::rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to) {
  // Plain rename() would replace an empty directory that appeared meanwhile.
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return -1;
  struct stat info {};
  if (::lstat(to.c_str(), &info) == 0) {
    errno = EEXIST;
    return -1;
  }
  return ::rename(from.c_str(), to.c_str());
}

int FileCalls::rename(const std::filesystem::path& from, const std::filesystem::path& to) {
  return ::rename(from.c_str(), to.c_str());
}

int FileCalls::unlink(const std::filesystem::path& path) { return ::unlink(path.c_str()); }

int FileCalls::set_mode(const std::filesystem::path& path, mode_t mode) { return ::chmod(path.c_str(), mode); }

int FileCalls::set_owner(const std::filesystem::path& path, uid_t user, gid_t group) {
  return ::lchown(path.c_str(), user, group);
}

void FileCalls::remove_all(const std::filesystem::path& path) noexcept {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

FileCalls& file_calls() noexcept {
  FileCalls* const calls = replaced.load();
  return calls != nullptr ? *calls : real_calls();
}

bool make_directories(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::is_directory(folder, error)) return false;
  if (folder.has_parent_path() && folder.parent_path() != folder) (void)make_directories(folder.parent_path());
  if (!folder.has_filename()) return false;  // a trailing slash
  if (file_calls().make_directory(folder) != 0) {
    const int reason = errno == EEXIST ? ENOTDIR : errno;
    if (std::filesystem::is_directory(folder, error)) return false;  // made meanwhile
    throw storage_error(reason, "create directory", folder);
  }
  // A power cut must not take it with all that is brought to the disk in it later.
  if (file_calls().sync_directory(std::filesystem::absolute(folder).parent_path()) == 0) return true;
  const int reason = errno;
  ::rmdir(folder.c_str());  // or the next attempt would take it for one that is on the disk
  throw storage_error(reason, "bring to disk directory", folder);
}

void remove_file(const std::filesystem::path& path) {
  if (file_calls().unlink(path) != 0 && errno != ENOENT) throw storage_error(errno, "remove", path);
}

ReplacedFileCalls::ReplacedFileCalls(FileCalls& calls) noexcept { replaced = &calls; }

ReplacedFileCalls::~ReplacedFileCalls() { replaced = nullptr; }

}  // namespace fvd
