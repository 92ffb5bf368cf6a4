#pragma once

/// Whether results can be kept: the database and the folder of results are those that were opened, can be written, and
/// have room.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <sys/types.h>

#include "core/base/error.hpp"

namespace fvd {

struct StorageProblem {
  ErrorCode code = ErrorCode::kStorageWrite;  ///< kDatabase, kStorageWrite, kStorageFull
  std::string message;                        ///< what is wrong, where, what to do
  bool operator==(const StorageProblem&) const = default;
};

/// context: thread-safe; a handful of calls of the file system, which a local disk answers without waiting.
class StorageWatch {
 public:
  /// Less is no room for a result, whatever a job needs.
  static constexpr std::uint64_t kLeastFree_bytes = std::uint64_t{16} << 20U;

  /// Remembers which files they are now. The database is open; a folder of results that is not there is a problem until
  /// the daemon starts anew.
  StorageWatch(std::filesystem::path database, std::filesystem::path results);

  /// Nothing where all is well.
  [[nodiscard]] std::optional<StorageProblem> look() const;

  /// Throws Error of the problem; kStorageFull where less than `needed_bytes` are free for a result beside what must
  /// stay free. what: of which recipe, for the message.
  void require_room(std::uint64_t needed_bytes, const std::string& what) const;

 private:
  /// Which file a path names.
  struct Identity {
    dev_t device = 0;
    ino_t inode = 0;
    bool operator==(const Identity&) const = default;
  };
  [[nodiscard]] static std::optional<Identity> identity_of(const std::filesystem::path& path);
  [[nodiscard]] std::string moved(const std::filesystem::path& path, const std::optional<Identity>& known) const;

  const std::filesystem::path database_;
  const std::filesystem::path results_;
  const std::optional<Identity> known_database_;
  const std::optional<Identity> known_results_;
};

}  // namespace fvd
