#include "daemon/store/storage_watch.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace fvd {

namespace {

namespace fs = std::filesystem;

struct Room {
  std::uint64_t free_bytes = 0;
  bool read_only = false;
};

std::optional<Room> room_in(const fs::path& folder) {
  struct statvfs disk {};
  if (::statvfs(folder.c_str(), &disk) != 0) return std::nullopt;
  return Room{static_cast<std::uint64_t>(disk.f_bavail) * disk.f_frsize, (disk.f_flag & ST_RDONLY) != 0};
}

std::string mib(std::uint64_t bytes) { return std::to_string(bytes >> 20U) + " MiB"; }

}  // namespace

StorageWatch::StorageWatch(fs::path database, fs::path results)
    : database_(std::move(database)),
      results_(std::move(results)),
      known_database_(identity_of(database_)),
      known_results_(identity_of(results_)) {}

std::optional<StorageWatch::Identity> StorageWatch::identity_of(const fs::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return std::nullopt;
  return Identity{info.st_dev, info.st_ino};
}

std::string StorageWatch::moved(const fs::path& path, const std::optional<Identity>& known) const {
  const auto now = identity_of(path);
  if (!now) return path.string() + " is gone or cannot be seen: " + std::strerror(errno);
  if (now != known) return path.string() + " is another one than when fvd started";
  return {};
}

std::optional<StorageProblem> StorageWatch::look() const {
  const std::string advice = ": put back what was there, or start fvd anew to go on with what is there now";
  if (const std::string problem = moved(database_, known_database_); !problem.empty()) {
    return StorageProblem{ErrorCode::kDatabase, "database " + problem + advice};
  }
  if (const std::string problem = moved(results_, known_results_); !problem.empty()) {
    return StorageProblem{ErrorCode::kStorageWrite, "the folder of results " + problem + advice};
  }
  const fs::path state = fs::absolute(database_).parent_path();
  for (const fs::path& folder : {state, results_}) {
    const auto room = room_in(folder);
    if (!room || room->read_only || ::access(folder.c_str(), W_OK | X_OK) != 0) {
      const std::string why = room && room->read_only ? "its file system is read-only" : std::strerror(errno);
      return StorageProblem{ErrorCode::kStorageWrite,
                            folder.string() + " cannot be written: " + why + ": make it writable for fvd"};
    }
    if (room->free_bytes < kLeastFree_bytes) {
      return StorageProblem{ErrorCode::kStorageFull, folder.string() + " has " + mib(room->free_bytes) +
                                                         " free, less than " + mib(kLeastFree_bytes) +
                                                         ": free some disk space"};
    }
  }
  return std::nullopt;
}

void StorageWatch::require_room(std::uint64_t needed_bytes, const std::string& what) const {
  if (const auto problem = look()) throw Error(problem->code, problem->message);
  const auto room = room_in(results_);
  if (!room || room->free_bytes >= needed_bytes + kLeastFree_bytes) return;
  throw Error(ErrorCode::kStorageFull, what + ": its result takes up to " + mib(needed_bytes) + ", " +
                                           results_.string() + " has " + mib(room->free_bytes) + " free, of which " +
                                           mib(kLeastFree_bytes) + " stay free: free some disk space");
}

}  // namespace fvd
