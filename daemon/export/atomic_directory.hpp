#pragma once

/// A directory that appears whole or not at all.

#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/export/durable_file.hpp"

namespace fvd {

/// Collects files in a hidden directory beside the final one (".<name>.<pid>-<n>.tmp", so that the rename stays within
/// one file system); commit() renames it when all files are on the disk. Without commit() nothing is left behind.
/// context: one thread at a time.
class AtomicDirectory {
 public:
  struct File {
    std::string name;  ///< relative to the directory
    std::uintmax_t size_bytes = 0;
  };

  /// The parent must exist, final_dir must not. Throws Error kStorageWrite, kStorageFull.
  explicit AtomicDirectory(const std::filesystem::path& final_dir);
  ~AtomicDirectory();
  AtomicDirectory(const AtomicDirectory&) = delete;
  AtomicDirectory& operator=(const AtomicDirectory&) = delete;

  /// Writes one new file; commit() brings it to the disk at the latest. name: "file" or "folder/file"; the
  /// folder is made on first use. Throws Error kStorageFull, kStorageWrite, kBadInput for any other name.
  void add_file(const std::filesystem::path& name, std::string_view bytes);
  /// The same for bytes that come one after the other; also throws what `produce` throws.
  void add_file(const std::filesystem::path& name, const ByteProducer& produce);

  /// Files added so far, in that order.
  [[nodiscard]] const std::vector<File>& files() const noexcept { return files_; }

  [[nodiscard]] const std::filesystem::path& final_dir() const noexcept { return final_dir_; }

  /// Brings the files and the directory to the disk under its final name. Nothing may be added after it. On an error
  /// nothing is left. Throws Error kStorageFull, kStorageWrite, also if final_dir has come into being meanwhile.
  void commit();

 private:
  void finish_oldest();

  std::filesystem::path final_dir_;
  std::filesystem::path temporary_;  // empty once committed
  std::vector<std::filesystem::path> folders_;
  std::vector<File> files_;
  std::deque<UnsyncedFile> unsynced_;
};

/// Deletes the temporary directories that a killed process left in `parent`; returns how many.
/// context: only while no AtomicDirectory is open in parent, e.g. at the start of the daemon.
std::size_t remove_abandoned_directories(const std::filesystem::path& parent);

}  // namespace fvd
