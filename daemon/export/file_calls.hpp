#pragma once

/// The calls of the system by which files reach the disk: in one place, so that tests can have each of them fail, and
/// can see what a power cut would leave.

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include <sys/types.h>

namespace fvd {

/// Each as the call of the system: -1 and errno where it fails.
/// context: thread-safe.
class FileCalls {
 public:
  virtual ~FileCalls() = default;
  /// A new file, open to be read and written, whatever `mode` allows later.
  virtual int create(const std::filesystem::path& path, mode_t mode);
  virtual ssize_t write(int fd, const void* bytes, std::size_t count);
  /// Room on the disk for a file of that many bytes.
  virtual int allocate(int fd, std::int64_t bytes);
  virtual int sync(int fd);
  virtual int close(int fd);
  virtual int make_directory(const std::filesystem::path& path);
  /// fsync() of a directory.
  virtual int sync_directory(const std::filesystem::path& path);
  /// Fails where `to` exists.
  virtual int rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to);
  virtual int rename(const std::filesystem::path& from, const std::filesystem::path& to);
  virtual int unlink(const std::filesystem::path& path);
  virtual int set_mode(const std::filesystem::path& path, mode_t mode);
  /// Of the path itself, also where it is a symbolic link.
  virtual int set_owner(const std::filesystem::path& path, uid_t user, gid_t group);
  /// A whole directory; what cannot be removed stays.
  virtual void remove_all(const std::filesystem::path& path) noexcept;
};

/// Those in force.
[[nodiscard]] FileCalls& file_calls() noexcept;

/// Makes a folder and those above it that are not there yet. True: it was not there.
/// Throws Error kStorageFull, kStorageWrite.
bool make_directories(const std::filesystem::path& folder);

/// Removes a file; one that is not there is as good. Throws Error kStorageFull, kStorageWrite.
void remove_file(const std::filesystem::path& path);

/// Puts others in force while it lives. For tests; one at a time.
class ReplacedFileCalls {
 public:
  explicit ReplacedFileCalls(FileCalls& calls) noexcept;
  ~ReplacedFileCalls();
  ReplacedFileCalls(const ReplacedFileCalls&) = delete;
  ReplacedFileCalls& operator=(const ReplacedFileCalls&) = delete;
};

}  // namespace fvd
