#pragma once

/// A disk that loses its power: what was written to it is recorded, and any state is made that a power cut may leave.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include "daemon/export/file_calls.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

/// Does every call and writes it down, below one folder. What a power cut leaves of the first n calls: all that was
/// brought to the disk by then, and of the rest any part: an entry of a directory without its file's bytes, the bytes
/// without the entry, a later call without an earlier one, a write that is cut off.
class CrashDisk final : public FileCalls {
 public:
  explicit CrashDisk(std::filesystem::path root) : root_(std::move(root)) { nodes_[root_] = 0; }

  int create(const std::filesystem::path& path, mode_t mode) override {
    const int fd = FileCalls::create(path, mode);
    const std::lock_guard lock(mutex_);
    if (fd >= 0) open_[fd] = enter(path);
    return fd;
  }
  ssize_t write(int fd, const void* bytes, std::size_t count) override {
    const ssize_t written = FileCalls::write(fd, bytes, count);
    const std::lock_guard lock(mutex_);
    if (written > 0) {
      calls_.push_back({.kind = Kind::kWrite,
                        .node = open_.at(fd),
                        .bytes = {static_cast<const char*>(bytes), static_cast<std::size_t>(written)}});
    }
    return written;
  }
  int sync(int fd) override {
    const int done = FileCalls::sync(fd);
    const std::lock_guard lock(mutex_);
    if (done == 0) calls_.push_back({.kind = Kind::kSync, .node = open_.at(fd)});
    return done;
  }
  int make_directory(const std::filesystem::path& path) override {
    const int done = FileCalls::make_directory(path);
    const std::lock_guard lock(mutex_);
    if (done == 0) {
      enter(path);
      calls_.back().directory = true;
    }
    return done;
  }
  int sync_directory(const std::filesystem::path& path) override {
    const int done = FileCalls::sync_directory(path);
    const std::lock_guard lock(mutex_);
    if (done == 0) calls_.push_back({.kind = Kind::kSync, .node = nodes_.at(path)});
    return done;
  }
  int rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to) override {
    const int done = FileCalls::rename_to_new(from, to);
    if (done == 0) note_rename(from, to);
    return done;
  }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    const int done = FileCalls::rename(from, to);
    if (done == 0) note_rename(from, to);
    return done;
  }

  /// A mark between the calls, e.g. that a row is durable from here on.
  void mark() {
    const std::lock_guard lock(mutex_);
    marks_.push_back(calls_.size());
  }
  [[nodiscard]] std::size_t calls() const { return calls_.size(); }
  /// How many marks lie within the first n calls.
  [[nodiscard]] int marks_within(std::size_t n) const {
    return static_cast<int>(std::count_if(marks_.begin(), marks_.end(), [n](std::size_t mark) { return mark <= n; }));
  }

  /// Makes in an empty root what may be left of the first n calls, as the dice fall.
  void leave(std::size_t n, std::mt19937& dice) const {
    std::map<int, Left> left;
    left[0].directory = true;
    for (std::size_t i = 0; i < n; ++i) {
      const Call& call = calls_[i];
      if (call.kind == Kind::kSync) continue;
      const bool durable = is_synced(call, i, n);
      if (!durable && dice() % 2 == 0) continue;
      apply(call, durable ? call.bytes.size() : call.bytes.size() - (dice() % 4 == 0 ? call.bytes.size() / 2 : 0),
            left);
    }
    make(0, root_, left);
  }

 private:
  enum class Kind { kEnter, kWrite, kSync, kRename };
  struct Call {
    Kind kind = Kind::kSync;
    int node = 0;
    int parent = 0;
    std::string name{};
    std::string new_name{};  ///< in the same directory
    bool directory = false;
    std::string bytes{};
  };
  struct Left {
    bool directory = false;
    std::string bytes;
    std::map<std::string, int> entries;
  };

  int enter(const std::filesystem::path& path) {
    const int node = static_cast<int>(nodes_.size() + 1000 * calls_.size());
    nodes_[path] = node;
    calls_.push_back({.kind = Kind::kEnter,
                      .node = node,
                      .parent = nodes_.at(path.parent_path()),
                      .name = path.filename().string()});
    return node;
  }
  void note_rename(const std::filesystem::path& from, const std::filesystem::path& to) {
    const std::lock_guard lock(mutex_);
    const int node = nodes_.at(from);
    calls_.push_back({.kind = Kind::kRename,
                      .node = node,
                      .parent = nodes_.at(from.parent_path()),
                      .name = from.filename().string(),
                      .new_name = to.filename().string()});
    nodes_.erase(from);
    nodes_[to] = node;
  }
  [[nodiscard]] bool is_synced(const Call& call, std::size_t i, std::size_t n) const {
    const int holder = call.kind == Kind::kWrite ? call.node : call.parent;
    return std::any_of(calls_.begin() + static_cast<std::ptrdiff_t>(i), calls_.begin() + static_cast<std::ptrdiff_t>(n),
                       [holder](const Call& later) { return later.kind == Kind::kSync && later.node == holder; });
  }
  static void apply(const Call& call, std::size_t bytes, std::map<int, Left>& left) {
    if (call.kind == Kind::kWrite) {
      left[call.node].bytes.append(call.bytes, 0, bytes);
      return;
    }
    auto& entries = left[call.parent].entries;
    if (call.kind == Kind::kEnter) {
      left[call.node].directory = call.directory;
      entries[call.name] = call.node;
      return;
    }
    if (entries.erase(call.name) == 0) return;  // what was to be renamed is lost
    entries[call.new_name] = call.node;
  }
  static void make(int node, const std::filesystem::path& path, std::map<int, Left>& left) {
    const Left& what = left[node];
    if (!what.directory) return write_text(path, what.bytes);
    std::filesystem::create_directories(path);
    for (const auto& [name, child] : what.entries) make(child, path / name, left);
  }

  const std::filesystem::path root_;
  std::mutex mutex_;
  std::map<std::filesystem::path, int> nodes_;  // that are there now
  std::map<int, int> open_;                     // file descriptor to node
  std::vector<Call> calls_;
  std::vector<std::size_t> marks_;
};

}  // namespace fvd::test
