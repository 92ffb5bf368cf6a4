#include "daemon/export/atomic_directory.hpp"

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kTemporarySuffix = ".tmp";

/// Open files on their way to the disk. While one waits for it the next is encoded; a few are enough to keep it busy.
constexpr std::size_t kMaxUnsynced = 8;

fs::path checked_final_dir(const fs::path& given) {
  fs::path path = fs::absolute(given).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // a trailing slash
  if (!path.has_filename()) throw Error(ErrorCode::kStorageWrite, "no directory can be made at " + given.string());
  struct stat info {};
  if (::lstat(path.c_str(), &info) == 0) {
    throw Error(ErrorCode::kStorageWrite, path.string() + " exists already: give another name, or move it away");
  }
  return path;
}

fs::path make_temporary(const fs::path& final_dir) {
  for (int attempt = 0;; ++attempt) {
    const std::string name = "." + final_dir.filename().string() + "." + std::to_string(::getpid()) + "-" +
                             std::to_string(attempt) + std::string(kTemporarySuffix);
    fs::path path = final_dir.parent_path() / name;
    if (file_calls().make_directory(path) == 0) return path;
    if (errno != EEXIST) throw storage_error(errno, "create directory", path);
  }
}

}  // namespace

AtomicDirectory::AtomicDirectory(const fs::path& final_dir)
    : final_dir_(checked_final_dir(final_dir)), temporary_(make_temporary(final_dir_)) {}

AtomicDirectory::~AtomicDirectory() {
  if (temporary_.empty()) return;
  file_calls().remove_all(temporary_);
}

void AtomicDirectory::add_file(const fs::path& name, std::string_view bytes) {
  add_file(name, [bytes](const ByteSink& sink) { sink(bytes); });
}

void AtomicDirectory::add_file(const fs::path& name, const ByteProducer& produce) {
  const auto parts = std::distance(name.begin(), name.end());
  const bool strange = std::any_of(name.begin(), name.end(),
                                   [](const fs::path& part) { return part.empty() || part == "." || part == ".."; });
  if (name.is_absolute() || strange || parts < 1 || parts > 2) {
    throw Error(ErrorCode::kBadInput, "'" + name.string() + "' is not of the form file or folder/file");
  }
  if (const fs::path folder = name.parent_path();
      !folder.empty() && std::find(folders_.begin(), folders_.end(), folder) == folders_.end()) {
    if (file_calls().make_directory(temporary_ / folder) != 0) {
      throw storage_error(errno, "create directory", temporary_ / folder);
    }
    folders_.push_back(folder);
  }
  unsynced_.emplace_back(temporary_ / name, produce);
  files_.push_back({name.string(), unsynced_.back().size_bytes()});
  if (unsynced_.size() > kMaxUnsynced) finish_oldest();
}

void AtomicDirectory::finish_oldest() {
  unsynced_.front().finish();
  unsynced_.pop_front();
}

void AtomicDirectory::commit() {
  while (!unsynced_.empty()) finish_oldest();
  for (const auto& folder : folders_) sync_directory(temporary_ / folder);
  sync_directory(temporary_);
  if (file_calls().rename_to_new(temporary_, final_dir_) != 0) {
    throw storage_error(errno, "rename the finished directory to", final_dir_);
  }
  try {
    sync_directory(final_dir_.parent_path());
  } catch (...) {
    // Under its hidden name again first: a part of it must not be seen.
    if (file_calls().rename(final_dir_, temporary_) != 0) file_calls().remove_all(final_dir_);
    throw;
  }
  temporary_.clear();
}

std::size_t remove_abandoned_directories(const fs::path& parent) {
  std::size_t removed = 0;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (!name.starts_with(".") || !name.ends_with(kTemporarySuffix) || !entry->is_directory(ignored)) continue;
    file_calls().remove_all(entry->path());
    if (!fs::exists(entry->path(), ignored)) ++removed;
  }
  return removed;
}

}  // namespace fvd
