#pragma once

/// Writing files that survive a power cut: every byte written, fsync after the last, no step's error ignored.

#include <filesystem>
#include <string_view>

#include "daemon/base/unique_fd.hpp"

namespace fvd {

/// Writes all bytes, continuing after short writes and signals. path only names the file in errors.
/// Throws Error kStorageFull, kStorageWrite.
void write_all(int fd, std::string_view bytes, const std::filesystem::path& path);

/// A new file whose bytes are written but not yet known to be on the disk. Destroyed without finish() the file stays as
/// it is.
class UnsyncedFile {
 public:
  /// Creates a file that must not exist yet, writes it and asks the kernel to begin bringing it to the disk. A file
  /// that could not be written is removed. Throws Error kStorageFull, kStorageWrite.
  UnsyncedFile(const std::filesystem::path& path, std::string_view bytes);

  /// Waits until it is on the disk. A file that could not be brought there is removed. Throws Error kStorageFull,
  /// kStorageWrite.
  void finish();

 private:
  std::filesystem::path path_;
  UniqueFd file_;
};

/// Creates a file that must not exist yet, writes it and brings it to the disk. A file that could not be finished is
/// removed. Throws Error kStorageFull, kStorageWrite.
void write_new_file(const std::filesystem::path& path, std::string_view bytes);

/// Brings a directory's entries to the disk. Throws Error kStorageWrite.
void sync_directory(const std::filesystem::path& directory);

}  // namespace fvd
