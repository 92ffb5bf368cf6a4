#pragma once

/// Writing files that survive a power cut: every byte written, fsync after the last, no step's error ignored.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

#include <sys/types.h>

#include "daemon/base/unique_fd.hpp"

namespace fvd {

/// Writes all bytes, continuing after short writes and signals. path only names the file in errors.
/// Throws Error kStorageFull, kStorageWrite.
void write_all(int fd, std::string_view bytes, const std::filesystem::path& path);

/// Takes the next bytes of a file.
using ByteSink = std::function<void(std::string_view bytes)>;
/// Gives all bytes of a file to the sink, in order.
using ByteProducer = std::function<void(const ByteSink& sink)>;

/// The group may read results: who looks after them need not be the daemon.
constexpr mode_t kReadableFile = 0644;

/// A new file whose bytes are written but not yet known to be on the disk. Destroyed without finish() the file stays as
/// it is.
class UnsyncedFile {
 public:
  /// Creates a file that must not exist yet, writes it and asks the kernel to begin bringing it to the disk. A file
  /// that could not be written is removed. Throws Error kStorageFull, kStorageWrite.
  UnsyncedFile(const std::filesystem::path& path, std::string_view bytes);
  /// The same for bytes that come one after the other; also throws what `produce` throws.
  UnsyncedFile(const std::filesystem::path& path, const ByteProducer& produce, mode_t mode = kReadableFile);

  /// Waits until it is on the disk. A file that could not be brought there is removed. Throws Error kStorageFull,
  /// kStorageWrite.
  void finish();

  [[nodiscard]] std::uint64_t size_bytes() const noexcept { return size_bytes_; }

 private:
  std::filesystem::path path_;
  UniqueFd file_;
  std::uint64_t size_bytes_ = 0;
};

/// Creates a file that must not exist yet, writes it and brings it to the disk. A file that could not be finished is
/// removed. Throws Error kStorageFull, kStorageWrite.
void write_new_file(const std::filesystem::path& path, std::string_view bytes);
void write_new_file(const std::filesystem::path& path, const ByteProducer& produce, mode_t mode = kReadableFile);
/// The same for a writer that goes back in its file. write: gets the file, open to be read and written; also throws
/// what it throws.
void write_new_file_at_will(const std::filesystem::path& path, const std::function<void(int fd)>& write);

/// Brings a directory's entries to the disk. Throws Error kStorageWrite.
void sync_directory(const std::filesystem::path& directory);

}  // namespace fvd
